"""Wrong answers to the exercises of lesson 04."""

SLOPES = "slopes = np.array([[length, length * np.tan(t)] for t in (theta0, theta1)])"

REST = (
    "k = deformable_model.tangent_pressure(length, theta0, theta1, n); "
    "return deformable_model.inflate(cubic(length, theta0, theta1, n), slopes, pressure=k).curve"
)

END = f"{SLOPES} / (n - 1); return deformable_model.inflate(cubic(length, theta0, theta1, n), slopes, pressure=k).curve"

# what students write, and words of the hint that they should get
WRONG = {
    "4.1": [
        ("return k * n ** 2 / 8", "N = n - 1"),
        ("return k * (n - 1) ** 2 / 2", "Four times"),
        ("return k * (n - 1) ** 2", "factor"),
        ("return k * (n + 1)**2 / 8", "N counts the steps between snaxels"),
        ("return k * (n - 1) / 8", "N is squared"),
        ("return k * (n - 1)**2 / 4", "2 times the right"),
        ("return k * (n-1) * (n-2) / 8", "The parabola is i (N - i)"),
        ("return k * n / 8", "N is squared"),
        ("return k", "goes with 1 / (n - 1)^2"),
        ("return -k * (n - 1)**2 / 8", "With k > 0 outward the apex lies outside"),
        ("return k * (n - 1)**2 / 8 * 0.45", "This is in mm of the paper's pixel"),
        ("return (n - 1)**2 / 8", "The pressure is missing"),
        ("return k * (n - 1) ** 2 / 16", "0.5 times the right"),
        ("return k * (n - 2) ** 2 / 8", "N counts the steps between snaxels"),
        ("return (k * (n - 1)) ** 2 / 8", "goes with k"),
        ("return k * (n - 1) / 2", "goes with 1 / (n - 1)"),
    ],
    "4.2": [
        ("return length * (np.tan(theta0) - np.tan(theta1)) / n ** 2", "N = n - 1"),
        ("return length * (np.tan(theta0) + np.tan(theta1)) / (n - 1) ** 2", "negative"),
        ("r = np.radians; return length * (np.tan(r(theta0)) - np.tan(r(theta1))) / (n - 1) ** 2", "radians"),
        ("return length * (np.tan(theta1) - np.tan(theta0)) / (n - 1) ** 2", "sign"),
        ("return length * (theta0 - theta1) / (n - 1) ** 2", "These are angles;"),
        ("return length * (theta0 + np.pi - theta1) / (n - 1) ** 2", "above the chord"),
        ("return length * (np.tan(theta0) - np.tan(theta1)) / (n - 1)", "N is squared"),
        ("return (np.tan(theta0) - np.tan(theta1)) / (n - 1)**2", "The length is missing"),
        ("return length * (np.tan(theta0) - np.tan(theta1)) / (n - 1)**2 / 2", "0.5 times the right"),
        ("return length * np.tan(theta0) / (n - 1)**2", "Only the first end is used"),
        ("return length * (np.sin(theta0) - np.sin(theta1)) / (n - 1)**2", "A slope is a tangent"),
        ("return length**2 * (np.tan(theta0) - np.tan(theta1)) / (n - 1)**2", "The length comes in once"),
        ("return length * (np.tan(theta0) - np.tan(np.pi - theta1)) / (n-1)**2", "tan theta1 is negative"),
        ("return (np.tan(theta0) - np.tan(theta1)) / (n-1)", "The length of a step is missing"),
        ("return (np.tan(theta0) - np.tan(theta1)) / length", "does not use `n`"),
        ("return 2 * length * np.tan(theta0) / (n-1)**2", "The first end is taken for both"),
        ("return 8 * length * (np.tan(theta0) - np.tan(theta1)) / (n-1)**2", "8 times the right"),
        ("return length * (theta1 - theta0) / (n - 1)", None),
        ("return length * np.tan(theta0 - theta1) / (n - 1)**2", "The difference of the two slopes is wanted"),
        ("return (n - 1)**2 / (length * (np.tan(theta0) - np.tan(theta1)))", None),
        ("return length * (np.tan(theta0) - np.tan(theta1)) / n", "N is squared"),
    ],
    "4.3": [
        (f"k = deformable_model.PAPER_PRESSURE; {END}", "paper's k"),
        (f"k = -deformable_model.tangent_pressure(length, theta0, theta1, n); {END}", "into the head"),
        (f"k = 0; {END}", "flat"),
        ("return np.linspace([0, 0], [length, 0], n)", "chord"),
        ("return cubic(length, theta0, theta1, n)", "start curve"),
        ("return spiral(length, theta0, theta1, n)[0]", "spiral"),
        (f"k = length * (np.tan(theta0) - np.tan(theta1)) / n**2; {END}", "too flat"),
        (f"{SLOPES} / n; {REST}", "n - 1 steps"),
        (f"{SLOPES}; {REST}", "divide by n - 1"),
        (f"slopes = np.array([[1, np.tan(t)] for t in (theta0, theta1)]); {REST}", "slopes are too small"),
        (f"slopes = np.array([[1, np.tan(t)] for t in (theta0, theta1)]) / (n - 1); {REST}", "far too small"),
        (f"slopes = np.zeros((2, 2)); {REST}", "far too small"),
        (f"{SLOPES}[::-1] / (n - 1); {REST}", "exchanged: theta0"),
        (f"{SLOPES} * [[1, 1], [1, -1]] / (n - 1); {REST}", "wrong sign"),
        (f"{SLOPES}[:, ::-1] / (n - 1); {REST}", "Along and out"),
        (
            f"slopes = length * np.array([[np.cos(t), np.sin(t)] for t in (theta0, theta1)]) / (n - 1); {REST}",
            "not cosine and sine",
        ),
        (f"n = n + 1; {SLOPES} / (n - 1); {REST}", "snaxel too many"),
        (f"k = 2 * deformable_model.tangent_pressure(length, theta0, theta1, n); {END}", "too hard"),
        (f"{SLOPES} / (n - 1); {REST.removesuffix('.curve')}", None),
        (
            "x = np.linspace(0, length, n); return np.column_stack([x, 4 * x * (length - x) / length**2])",
            "does not use",
        ),
    ],
}
