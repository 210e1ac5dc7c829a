"""The numbers in the texts of a lesson, and those that its cells and its sources know."""

import ast
import inspect
import re
from pathlib import Path

from lesson_cells import FOLDER

from cranio_nb.evaluation import paper_tables
from cranio_nb.methods.catalogue import METHODS, find_method
from cranio_nb.teaching import exercises
from data_synth import phantom_case

WORDS = {word: float(7 + i) for i, word in enumerate("seven eight nine ten eleven twelve".split())}
UNIT = (
    r"mm2?|cm[23]?|px2?|HU|degrees?|times|(?:more )?(?:pixel|point|slice|plane|step|snaxel|head|draw|voxel|part|"
    r"direction|column|row|hole|skull|node|triangle|face)s?"
)
NUMBER = re.compile(rf"(?<![\w.^])(?:\d+\.\d+|\d{{2,}}|\d(?=\s(?:%|(?:{UNIT})\b))|{'|'.join(WORDS)})(?!\w)")
NAMED = r"[Ll]essons?|[Ss]ections?|Fig(?:ures?|\.)|Tables?|eqs?\.|[Ee]quations?|[Ee]xercises?|[Qq]uestions?|[Ss]tages?"
CLAIMS_NOTHING = re.compile(
    rf"""`[^`]*` | ^\#[^\n]* | ^\s*\d+\.\s | \(\d\) | \bdoi\s+\S+ | \b(?:19|20)\d\d\b | \d+\s(?:seconds|minutes)
    | \b(?:{NAMED})\s+\(?\d[\d.]*\)?(?:\s*(?:,|and|to)\s*\(?\d+\)?(?!\.?\d|\s*(?:%|(?:{UNIT})\b)))*
    | \b(?:90|180)(?=\s(?:degrees|-\s)) | \*\*(?:Time:|Further\ reading).*?(?:\n\s*\n|\Z)""",
    re.M | re.S | re.X,
)
PAPER = {  # what the paper says outside its tables
    *(1000, 400),  # section 2: the CT numbers, those of bone
    *(512, 68, 23, 3, 20),  # section 3: the volume; slices with an opening, three by the hull, "the other ones"
    *(10, 21, 0.062, 0.001),  # points left out, snaxels on average, k, the stop
}
WHOLE = ("", "Parameters", "Summary")


def numbers(text):
    """The values that stand in a text, without their signs."""
    return {float(number) for number in re.findall(r"\d+(?:\.\d+)?", text)}


def spoken(text):
    """The numbers of a text that claim something, as they are written."""
    shown = re.sub(r"\$\$?([^$]*)\$\$?", lambda formula: " ".join(re.findall(r"\d+\.\d+", formula[1])), text)
    return NUMBER.findall(CLAIMS_NOTHING.sub(" ", shown))


def value(number):
    return WORDS.get(number) or float(number)


def literals(source):
    """The numbers that are written in code, without their signs."""
    values = (node.value for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Constant))
    return {float(v) for v in values if isinstance(v, int | float)}


def typed_texts(source):
    """The plain texts in code."""
    return [node.value for node in ast.walk(ast.parse(source)) if is_text(node)]


def alternatives(source):
    """What is said of a picture to those who do not see it."""
    named = [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.Assign)]
    return [node.value.value for node in named if ast.unparse(node.targets[0]) == "alt" and is_text(node.value)]


def is_text(node):
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def sections(notebook):
    """Heading -> its texts and its cells; what stands above the first heading of the second level has none."""
    parts = {"": ([], [])}
    for cell in notebook.cells:
        if cell.cell_type == "code":
            texts, cells = [*parts.values()][-1]
            cells.append(cell)
            texts.extend(alternatives(cell.source))
            continue
        first, *others = re.split(r"^## ", cell.source, flags=re.M)
        [*parts.values()][-1][0].append(first)
        parts.update({part.split("\n")[0]: ([part.partition("\n")[2]], []) for part in others})
    return parts


def printed_by(cells):
    """What cells print, say of their pictures, or fail with."""
    outputs = [out for cell in cells for out in cell.outputs]
    return numbers("\n".join(o.get("text") or o.get("evalue") or o.data.get("text/plain", "") for o in outputs))


def known_to(cells):
    """Results that cells print and settings that they are given."""
    return printed_by(cells).union(*(literals(cell.source) for cell in cells))


def asked(lesson):
    """The numbers that the checks of a lesson's exercises try."""
    task = exercises.EXERCISES[f"{int(lesson[:2])}.1"]
    return literals(Path(inspect.getfile(task.cases)).read_text())


def defaults():
    """The defaults of the methods' options."""
    known = [inspect.getfullargspec(find_method(name).pieces).kwonlydefaults for name in METHODS]
    return {float(v) for options in known for v in (options or {}).values() if isinstance(v, int | float)}


def printed_by_the_paper():
    """The numbers of the paper's tables and of its text."""
    rows = paper_tables.PAPER_DISTANCES.values()
    pairs = [pair for side in paper_tables.PAPER_BALLOONS.values() for pair in side.values()]
    return PAPER.union(*pairs, *((row.min, row.max, row.mean, row.std) for row in rows))


def sources_of(paragraph):
    """The numbers of the sources that a paragraph names."""
    found = printed_by_the_paper() if re.search(r"\bpaper\b|\bauthors\b", paragraph) else set()
    if "README" in paragraph:
        found |= numbers((FOLDER.parent / "README.md").read_text())
    if "data_synth.phantom" in paragraph:
        found |= literals(Path(inspect.getfile(phantom_case)).read_text())
    return found


def lost_numbers(lesson, notebook):
    """(heading, number, where) of each number of the texts that nothing shows."""
    parts = sections(notebook)
    known = {heading: known_to(cells) for heading, (_, cells) in parts.items()}
    setup = set().union(*(known.get(heading, set()) for heading in WHOLE[:2]))
    setup |= {value(number) for text in parts.get("Parameters", ((),))[0] for number in spoken(text)}
    for heading, more in (("Exercises", asked(lesson)), ("Parameters", defaults())):
        known[heading] = known.get(heading, set()) | more
    lost = []
    for heading, (texts, _) in parts.items():
        for paragraph in re.split(r"\n\s*\n", "\n\n".join(texts)):
            near = known[heading] | setup | sources_of(paragraph)
            named = re.findall(r"[Ss]ections? (\d)(?: (?:and|to) (\d))?", paragraph)
            near = near.union(*(known[h] for h in parts if h[:1] in {n for pair in named for n in pair} - {""}))
            near = near.union(*known.values()) if heading in WHOLE else near
            lost += [(heading, n, paragraph[:60]) for n in spoken(paragraph) if value(n) not in near]
    return lost
