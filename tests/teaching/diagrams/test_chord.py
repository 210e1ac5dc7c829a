"""The drawn chord frame: its arrows stand at theta0 and theta1, its parabola is k N^2 / 8 high."""

import re

import numpy as np
import pytest

from cranio_nb.curves import GapEnds
from cranio_nb.drawing.palette import START, TANGENT, rgb_shares
from cranio_nb.teaching.diagrams import Gap, chord_at_rest, chord_frame, marks
from cranio_nb.teaching.diagrams.chord import draw_angles, draw_gap

RADIUS, HALF_RAD = 40.0, 0.3


@pytest.fixture
def gap(ring):
    """A gap towards the patient's left in a circle: its ends rise by half its angle."""
    turn = np.array([-HALF_RAD, HALF_RAD])
    points = 100 + RADIUS * np.column_stack([np.sin(turn), np.cos(turn)])
    tangents = np.column_stack([np.cos(turn), -np.sin(turn)]) * [[1.0], [-1.0]]
    around = np.linspace(*turn, 41)
    truth = 100 + RADIUS * np.column_stack([np.sin(around), np.cos(around)])
    bone = ring(RADIUS - 6, RADIUS, half_gap=np.degrees(HALF_RAD), towards=90.0)
    return Gap(GapEnds(points, tangents), (100.0, 100.0), bone, 0.5, truth)


@pytest.fixture
def ax(gap):
    return draw_gap(marks.sheet(3.1), gap)


def test_the_arrows_stand_at_the_angles_of_the_ends(gap, ax):
    arrows = [text for text in ax.texts if getattr(text, "arrow_patch", None)]
    green = [t for t in arrows if np.allclose(t.arrow_patch.get_edgecolor()[:3], rgb_shares(TANGENT))]
    ways = np.array([np.subtract(t.xy, t.xyann) for t in green])
    assert np.arctan2(*ways.T[::-1]) == pytest.approx(np.array([HALF_RAD, np.pi - HALF_RAD]))
    assert gap.angles == pytest.approx((HALF_RAD, np.pi - HALF_RAD))
    assert np.array([t.xyann for t in green]) == pytest.approx(np.array([[0, 0], [2 * RADIUS * np.sin(HALF_RAD), 0]]))


def test_the_arcs_end_on_the_arrows(gap, ax):
    n_lines = len(ax.lines)
    draw_angles(ax, gap, None)
    for line, x, lean in zip(ax.lines[n_lines:], (0.0, gap.frame.length), gap.angles, strict=True):
        tip = line.get_xydata()[-1] - [x, 0.0]
        assert np.arctan2(tip[1], tip[0]) == pytest.approx(lean)


def test_the_start_curve_is_dashed_and_leaves_along_the_arrows(gap, ax):
    (start,) = [line for line in ax.lines if line.get_color() == START]
    step = np.diff(start.get_xydata(), axis=0)
    assert start.get_linestyle() == "--" and np.arctan(step[0, 1] / step[0, 0]) == pytest.approx(HALF_RAD, abs=0.01)


def test_values_and_expected_values_are_written(gap):
    drawn = chord_frame(gap, expected_deg=(17.0, 163.0))
    found = [float(number) for number in re.findall(r"\d+\.\d", drawn.line)]
    assert found == pytest.approx([gap.frame.length, *np.degrees([HALF_RAD, np.pi - HALF_RAD])], abs=0.05)


def test_the_apex_is_k_n2_over_8_and_the_balloon_a_little_higher(gap):
    apex, rest, start, true = map(float, re.findall(r"\d+\.\d", chord_at_rest(gap, 0.03, n=21).line.split("/8")[1]))
    assert apex == pytest.approx(0.03 * 20**2 / 8, abs=0.05) and apex < rest < start
    assert true == pytest.approx(RADIUS * (1 - np.cos(HALF_RAD)), abs=0.05)
