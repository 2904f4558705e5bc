"""The example files that the chapters take their systems from."""

PAPER = "examples/paper/paper.mac"
BEAD = "examples/bead.mac"
BOB = "examples/whirling_bob.mac"
CABIN = "examples/weightless_cabin.mac"
LINKAGE = "examples/linkage.mac"
PENDULUM = "examples/pendulum.mac"
PRESCRIBED_TENSION = "examples/prescribed_tension.mac"
SPHERICAL_PENDULUM = "examples/spherical_pendulum.mac"

FREE_SCENE = "free_motion_scene"
INITIAL_SCENE = "initial_motion_scene"
BOB_SCENE = "drawn_in_scene"
