"""Wrong answers to the exercises of lesson 11."""

GAIN = "gain = scores - scores[:, [usual]]"
BOTH = "a, b = table.mean(axis=1, keepdims=True), table.mean(axis=0, keepdims=True)"
EACH = "found = [scores[i, np.delete(scores, i, axis=0).mean(axis=0).argmax()] for i in range(len(scores))]"

# what students write, and words of the hint that they should get
WRONG = {
    "11.1": [
        ("return np.array([scores.mean(axis=0), scores.std(axis=0, ddof=1)])", "These are the scores themselves"),
        (f"{GAIN}; return np.array([gain.mean(axis=0), gain.std(axis=0)])", "ddof=1"),
        (f"{GAIN}; return np.array([gain.mean(axis=0), scores.std(axis=0, ddof=1)])", "how heads differ"),
        (f"{GAIN}; return np.array([scores.mean(axis=0), gain.std(axis=0, ddof=1)])", "The mean is that of the scores"),
        (f"{GAIN}; return np.array([-gain.mean(axis=0), gain.std(axis=0, ddof=1)])", "sign is turned"),
        (f"{GAIN}; return np.array([np.abs(gain).mean(axis=0), gain.std(axis=0, ddof=1)])", "losses count as gains"),
        (
            "gain = scores - scores[:, [0]]; return np.array([gain.mean(axis=0), gain.std(axis=0, ddof=1)])",
            "Always against the first",
        ),
        (f"{GAIN}; return np.array([gain.mean(axis=0), gain.var(axis=0, ddof=1)])", "the variance"),
        (
            f"{GAIN}; return np.array([gain.mean(axis=0), gain.std(axis=0, ddof=1) / np.sqrt(len(gain))])",
            "the error of the mean",
        ),
        (f"{GAIN}; return np.array([np.median(gain, axis=0), gain.std(axis=0, ddof=1)])", "the median"),
        (f"{GAIN}; return np.array([gain.mean(axis=1), gain.std(axis=1, ddof=1)])", "Heads are rows"),
        (
            "gain = scores - scores.mean(); return np.array([gain.mean(axis=0), gain.std(axis=0, ddof=1)])",
            "from the mean of all",
        ),
        (
            "gain = scores - scores.mean(axis=1, keepdims=True); "
            "return np.array([gain.mean(axis=0), gain.std(axis=0, ddof=1)])",
            "each head's mean",
        ),
        (f"{GAIN}; return np.array([gain.mean(axis=0), gain.max(axis=0) - gain.min(axis=0)])", "the range"),
        (f"{GAIN}; return gain.mean(axis=0)", "Only the mean"),
        (f"{GAIN}; return np.array([gain.std(axis=0, ddof=1), gain.mean(axis=0)])", "The mean comes first"),
        (f"{GAIN}; return np.column_stack([gain.mean(axis=0), gain.std(axis=0, ddof=1)])", "yours are columns"),
        (f"{GAIN}; return np.array([gain.sum(axis=0), gain.std(axis=0, ddof=1)])", "sums of gains"),
        (f"{GAIN}; return np.array([gain.mean(axis=0), [gain.std(ddof=1)] * gain.shape[1]])", "One spread over all"),
        (f"{GAIN}; return gain", None),
        (
            "gain = scores - scores[:, usual]; return np.array([gain.mean(axis=0), gain.std(axis=0)])",
            "keep it a column",
        ),
        (
            "gain = scores[:, usual] - scores; return np.array([gain.mean(axis=0), gain.std(axis=0)])",
            "keep it a column",
        ),
        (
            f"{GAIN}; d = scores.std(axis=0, ddof=1); return np.array([gain.mean(axis=0), d - d[usual]])",
            "The difference of two spreads",
        ),
        (
            f"{GAIN}; d = scores.std(axis=0, ddof=1); return np.array([gain.mean(axis=0), np.hypot(d, d[usual])])",
            "as if apart",
        ),
        (
            "gain = scores / scores[:, [usual]] - 1; return np.array([gain.mean(axis=0), gain.std(axis=0, ddof=1)])",
            "relative gains",
        ),
    ],
    "11.2": [
        ("return (length / (n - 1)) ** 2 / radius", "twice the pressure"),
        ("return (length / (n - 1)) ** 2 / radius / tension", "Divided by the tension"),
        ("return tension * (length / n) ** 2 / radius", "n - 1 steps"),
        ("return tension * (length / (n + 1)) ** 2 / radius", "n - 1 steps"),
        ("return tension * (length / (n - 2)) ** 2 / radius", "n - 1 steps"),
        ("return tension * (length / (n - 1)) ** 4 / radius**3", "the rigidity's part"),
        ("return tension * (length / n - 1) ** 2 / radius", "put n - 1 in brackets"),
        ("return tension * length / (n - 1) / radius", "squared"),
        ("return tension * (length / (n - 1)) ** 2 * radius", "Multiplied by the radius"),
        ("return tension * (length / (n - 1)) ** 2 / radius**2", "not its square"),
        ("return tension * (length / (n - 1)) ** 2 / (2 * radius)", "not half of it"),
        ("return tension**2 * (length / (n - 1)) ** 2 / radius", "once, not squared"),
        ("return tension * length**2 / radius", "whole length"),
        ("return tension * (length / (n - 1)) ** 2", "The radius is not used"),
        ("return tension / radius", "per index squared it is"),
        ("return tension * length**2 / (8 * radius)", "the height of the bow"),
        (
            "rise = radius - np.sqrt(radius**2 - length**2 / 4); return 8 * tension * rise / (n - 1) ** 2",
            "shallow bow only",
        ),
        (
            "rise = radius * (1 - np.cos(length / 2 / radius)); return 8 * tension * rise / (n - 1) ** 2",
            "shallow bow only",
        ),
        ("return -tension * (length / (n - 1)) ** 2 / radius", "Outward is positive"),
        ("return 2 * tension * (length / (n - 1)) ** 2 / radius", "2 times the right"),
        ("return tension * length**2 / (n - 1) / radius", "goes with (n - 1)"),
        ("h = length / (n - 1); return tension * h**2 / radius + h**4 / radius**3", "rigidity is still in it"),
        ("h = length / (n - 1); return tension * (h**2 / radius + h**4 / radius**3)", "rigidity is still in it"),
        ("h = length / (n - 1); return tension * h**2 / radius - h**4 / radius**3", "rigidity is still in it"),
        (
            "chord = 2 * radius * np.sin(length / 2 / radius); return tension * (chord / (n - 1)) ** 2 / radius",
            "chord from end to end",
        ),
        (
            "arc = 2 * radius * np.arcsin(length / 2 / radius); return tension * (arc / (n - 1)) ** 2 / radius",
            "for the chord from end to end",
        ),
        (
            "h = 2 * radius * np.sin(length / (n - 1) / 2 / radius); return tension * h**2 / radius",
            "takes a step straight",
        ),
        ("h = length / (n - 1); return 2 * tension * (1 - np.cos(h / radius)) * radius", "takes a step straight"),
    ],
    "11.3": [
        (f"{BOTH}; return table - a - b", "taken off twice"),
        ("return table - table.mean(axis=1, keepdims=True)", "Only the rows"),
        ("return table - table.mean(axis=0)", "Only the columns"),
        ("return table - table.mean()", "what each parameter does alone"),
        (f"{BOTH}; return a + b - table.mean()", "without an interaction"),
        (f"{BOTH}; return a + b - table.mean() - table", "The sign is turned"),
        (f"{BOTH}; return table - a - b + 2 * table.mean()", "once, not twice"),
        (f"{BOTH}; return table - a - b - table.mean()", "not taken off a third time"),
        (f"{BOTH}; return np.abs(table - a - b + table.mean())", "keep them"),
        (f"{BOTH}; return (table - a - b + table.mean()) ** 2", "These are squares"),
        (f"{BOTH}; return np.abs(table - a - b + table.mean()).max()", "a table is wanted"),
        (f"{BOTH}; return table / a / b * table.mean()", "These are ratios"),
        (
            "a, b = np.median(table, axis=1, keepdims=True), np.median(table, axis=0); "
            "return table - a - b + np.median(table)",
            "These are medians",
        ),
        ("return table - table[0] - table[:, :1] + table[0, 0]", "from the first level"),
        (f"{BOTH}; return (table - a - b + table.mean()) / table.std()", "No need to scale"),
        ("return table", "as it was given"),
        ("return table - table.mean(axis=1) - table.mean(axis=0) + table.mean()", "keep it a column"),
    ],
    "11.4": [
        ("return scores.mean(axis=0).max()", "chosen by the heads that it is judged by"),
        ("return scores.max(axis=1).mean()", "best for itself"),
        ("return scores.mean()", "the mean of all settings"),
        ("return scores.max()", "the best score of all"),
        (
            "return np.mean([np.delete(scores, i, axis=0).mean(axis=0).max() for i in range(len(scores))])",
            "on the heads they were chosen by",
        ),
        (
            "return np.mean([scores[i, np.delete(scores, i, 0).mean(axis=0).argmin()] for i in range(len(scores))])",
            "The worst setting",
        ),
        ("return np.mean([scores[i, scores[i - 1].argmax()] for i in range(len(scores))])", "the one before"),
        (
            "n = len(scores); return np.mean([scores[i, scores[(i + 1) % n].argmax()] for i in range(n)])",
            "the next one",
        ),
        (f"{EACH}; return np.median(found)", "the median"),
        (f"{EACH}; return min(found)", "the worst of the heads"),
        (f"{EACH}; return max(found)", "the best of the heads"),
        (f"{EACH}; return sum(found)", "divide it by the number"),
        (f"{EACH}; return np.array(found)", "return their mean"),
        (
            "return [np.delete(scores, i, axis=0).mean(axis=0).argmax() for i in range(len(scores))]",
            "the settings chosen",
        ),
        ("return scores[0, np.delete(scores, 0, axis=0).mean(axis=0).argmax()]", "Only the first head"),
        ("return scores[-1, np.delete(scores, -1, axis=0).mean(axis=0).argmax()]", "Only the last head"),
        (
            "return np.mean([scores[i, np.delete(scores, i, 0).max(axis=0).argmax()] for i in range(len(scores))])",
            "by the single best score",
        ),
        ("return scores[range(len(scores)), (scores.sum() - scores).argmax(axis=1)].mean()", "along axis=0"),
        (f"scores = scores.T; {EACH}; return np.mean(found)", "Rows are heads"),
        ("return scores[:, 1:].mean(axis=0).max()", None),
        (
            "best = scores.mean(axis=0).argmax(); return scores[:, best].mean()",
            "chosen by the heads that it is judged by",
        ),
        (
            "best = [np.delete(scores, i, 0).mean(axis=0).argmax() for i in range(len(scores))]; "
            "return scores[:, best].mean()",
            "every head with every choice",
        ),
        (
            "return np.mean([np.delete(scores, i, 0)[:, scores[i].argmax()].mean() for i in range(len(scores))])",
            "Turned round",
        ),
        (
            "best = [np.median(np.delete(scores, i, 0), axis=0).argmax() for i in range(len(scores))]; "
            "return scores[range(len(scores)), best].mean()",
            "by the median of the others",
        ),
        (
            "best = [np.delete(scores, i, 0).min(axis=0).argmax() for i in range(len(scores))]; "
            "return scores[range(len(scores)), best].mean()",
            "by the worst case of the others",
        ),
    ],
}
