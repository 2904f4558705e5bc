"""Chapters with computations of their own, and the examples that they use.

Each has a function `page(results)`, which computes values, and may have `RUNS` besides those in the head of its page.
"""

from ...files import shared

EXAMPLES = shared("examples")
PAPER = EXAMPLES / "paper/paper.mac"
BEAD = EXAMPLES / "bead.mac"
TILTED_PLANE = EXAMPLES / "paper/knob.mac"
PENDULUM = EXAMPLES / "pendulum.mac"

FREE_SCENE = "free_motion_scene"
INITIAL_SCENE = "initial_motion_scene"
