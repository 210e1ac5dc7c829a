"""How soon a student sees what a slider does: prints the time from a key press to the painted picture in JupyterLab.

    python benchmarks/keypress.py [--presses 40] [--size full]

A real Chromium opens a lab as `cranio-nb lab` does. Timed inside the page, from the key's event to the first frame
after the new picture was decoded. Beside it the same slice through `interactive_output` and a new matplotlib figure.
Needs the extras lab, view and test, and Chromium.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests" / "helpers"))
from browser_lab import ARGS, browser_path, run_all, running_lab, write_notebook
from playwright.sync_api import Locator, sync_playwright

CELLS = (
    """
import ipywidgets, matplotlib.pyplot as plt
import cranio_nb as cn
from cranio_nb.stages import feature_extraction
from cranio_nb.teaching import widgets
from data_synth import phantom_case
case = phantom_case("{size}")
ct, bone = cn.Volume(case.hu, case.affine), cn.Volume(case.bone, case.affine)
opening, px = cn.find_openings(bone)[0], float(bone.spacing[1])
plane = sum(opening.planes) // 2
""",
    """
def draw(plane):
    plt.figure(figsize=(5, 5)); plt.imshow(ct.voxels[plane], cmap="gray"); plt.show()
slider = ipywidgets.IntSlider(value=plane, max=ct.shape[0] - 1, description="peer")
ipywidgets.VBox([slider, ipywidgets.interactive_output(draw, {{"plane": slider}})])
""",
    "widgets.ct_viewer(ct)",
    "widgets.threshold(ct)",
    "widgets.features(bone, plane, opening=opening.sheet)",
    """
seen = feature_extraction.extract_features(bone.voxels[plane])
ends, _ = feature_extraction.find_gap_ends(seen, opening.sheet.voxels[plane], skip_px=4.5 / px)
widgets.balloon(ends, bone.to_voxel(opening.head_centre)[1:], background=bone.voxels[plane], px=px)
""",
)
SLIDERS = (
    ("new matplotlib figure: slice", "peer", "Arrow"),
    ("ct_viewer: slice", "slice (", "Arrow"),
    ("threshold: HU", "threshold: bone", "Arrow"),
    ("features: reach", "reach", "Page"),  # half a millimetre may leave the picture as it is
    ("balloon: k", "k: pressure", "Page"),
)
WATCH = """
(box) => {
  const seen = new WeakMap(), state = {pressed: null, took: []};
  window.keypress = state;
  const done = () => {
    if (state.pressed !== null) { state.took.push(performance.now() - state.pressed); state.pressed = null; }
  };
  const painted = () => requestAnimationFrame(() => {  // a message posted before a frame arrives after it is painted
    const channel = new MessageChannel();
    channel.port1.onmessage = done;
    channel.port2.postMessage(null);
  });
  const look = () => box.querySelectorAll('img').forEach((img) => {
    if (seen.get(img) !== img.src) { seen.set(img, img.src); img.decode().then(painted, painted); }
  });
  box.querySelectorAll('img').forEach((img) => seen.set(img, img.src));
  window.addEventListener('keydown', () => { state.pressed = performance.now(); }, true);
  new MutationObserver(look).observe(box, {subtree: true, childList: true, attributes: true, attributeFilter: ['src']});
}
"""


def times(box: Locator, label: str, keys: str, presses: int) -> np.ndarray:
    """Milliseconds from each press to its picture, for the slider of this name; every press is waited for."""
    page = box.page
    back, forth = ("ArrowLeft", "ArrowRight") if keys == "Arrow" else ("PageDown", "PageUp")
    box.scroll_into_view_if_needed()
    box.evaluate(WATCH)
    box.get_by_role("slider", name=label).or_(box.locator(".noUi-handle")).first.focus()
    for i in range(presses):
        page.keyboard.press(back if i % 4 < 2 else forth)
        page.wait_for_function(f"window.keypress.took.length > {i}", timeout=20_000)
        page.wait_for_timeout(60)
    return np.array(page.evaluate("window.keypress.took"))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--presses", type=int, default=40)
    parser.add_argument("--size", default="full")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as place, sync_playwright() as play:
        folder = Path(place) / "notebooks"
        folder.mkdir()
        write_notebook(folder / "keys.ipynb", [cell.format(size=asked.size) for cell in CELLS])
        browser = play.chromium.launch(executable_path=browser_path(), headless=True, args=list(ARGS))
        with running_lab(folder, Path(place)) as address:
            page = browser.new_page(viewport={"width": 1500, "height": 1200})
            run_all(page, address, "keys.ipynb")
            print(f"{'slider':34} {'median':>8} {'p95':>8}   ms, {asked.presses} presses")
            for name, label, keys in SLIDERS:
                named = page.get_by_role("slider", name=label).or_(page.locator(".widget-label", has_text=label))
                box = page.locator(".jp-OutputArea-child", has=named).first
                took = times(box, label, keys, asked.presses)
                print(f"{name:34} {np.median(took):8.0f} {np.percentile(took, 95):8.0f}", flush=True)
        browser.close()


if __name__ == "__main__":
    main()
