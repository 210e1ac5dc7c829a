"""The default install of this BSD package holds no copyleft: a user may pass it on under its own licence."""

import re
import tomllib
from importlib.metadata import Distribution, distribution
from pathlib import Path

from packaging.requirements import Requirement

COPYLEFT = re.compile(r"\b[AL]?GPL|GENERAL PUBLIC|\bEUPL|\bSSPL|\bCC-BY-(SA|NC)", re.IGNORECASE)
# licences that the metadata do not name, or name beside others; each read by a person
REVIEWED: dict[str, str] = {}


def default_install() -> dict[str, Distribution]:
    """Every distribution that the core dependencies of pyproject.toml bring, by name; extras are not followed."""
    project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    found: dict[str, Distribution] = {}
    waiting = [Requirement(text) for text in project["dependencies"]]
    while waiting:
        wanted = waiting.pop()
        name = re.sub(r"[-_.]+", "-", wanted.name).lower()
        if name in found:
            continue
        found[name] = distribution(wanted.name)
        for needed in map(Requirement, found[name].requires or []):
            if needed.marker is None or any(needed.marker.evaluate({"extra": e}) for e in ("", *wanted.extras)):
                waiting.append(needed)
    return found


def licence_of(package: Distribution) -> str:
    """What the metadata say of the licence: the expression, the classifiers, the first line of the free text."""
    meta = package.metadata
    classifiers = [c for c in meta.get_all("Classifier") or [] if c.startswith("License")]
    free = (meta.get("License") or "").strip().split("\n")[0]
    return "; ".join([meta.get("License-Expression") or "", free, *classifiers]).strip("; ")


def test_no_default_dependency_is_copyleft() -> None:
    found = default_install()
    assert {"numpy", "pydicom", "imagecodecs"} <= set(found)
    licences = {name: REVIEWED.get(name) or licence_of(package) for name, package in found.items()}
    assert {name: text for name, text in licences.items() if COPYLEFT.search(text)} == {}
    assert [name for name, text in licences.items() if not text] == []


def test_a_copyleft_licence_would_be_seen() -> None:
    for text in ("GPL V3.0", "GPLv3", "LGPL-2.1-or-later", "GNU Affero General Public License v3", "AGPL-3.0-only"):
        assert COPYLEFT.search(text)
    for text in ("BSD-3-Clause", "MIT", "Apache-2.0", "MPL-2.0", "HPND", "PSF-2.0"):
        assert not COPYLEFT.search(text)
