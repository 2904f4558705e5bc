"""Chapters with computations, one per module, and the examples that they use.

Each has a function `runs(root)`, the runs that it needs, of those in `holonom.companion.runs` or of any function of a
module, and a function `page(root, results)`, which makes the page's content, figures and sources of their results. The
root is the repository. `contents.toml` gives the chapters their order.
"""

PAPER = "examples/paper/paper.mac"
BEAD = "examples/bead.mac"
BOB = "examples/whirling_bob.mac"
CABIN = "examples/weightless_cabin.mac"
KNOB = "examples/paper/knob.mac"
LINKAGE = "examples/linkage.mac"
PENDULUM = "examples/pendulum.mac"
PRESCRIBED_TENSION = "examples/prescribed_tension.mac"
SPHERICAL_PENDULUM = "examples/spherical_pendulum.mac"

FREE_SCENE = "free_motion_scene"
INITIAL_SCENE = "initial_motion_scene"
BOB_SCENE = "drawn_in_scene"
