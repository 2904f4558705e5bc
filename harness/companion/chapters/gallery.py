"""The gallery: every example of the repository in motion."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path

from ...language import translatable
from ..chapter import Chapter, Page
from ..motions import Motion, figures_of, motion


@dataclass(frozen=True)
class Exhibit:
    """A scene that is shown."""

    name: str  # what the names of its figures begin with
    file: str  # relative to the root
    to_see: tuple[str, str]  # what to look at in the drawing, and what in the curves
    scene: str | None = None  # without a name, the last one of the file
    until: Fraction | None = None  # where the film ends, if not with the scene


EXHIBITS = (
    Exhibit(
        "free-particle",
        "examples/paper/paper.mac",
        (
            translatable(
                "The paper's example as a particle in space on a plane, of which the piece between its hinge on the "
                "ground and the particle is drawn. The plane is tilted ever faster, and the particle stays on it by "
                "itself."
            ),
            translatable(
                "The multiplier is rounding noise, as the power of ten at its axis says: the motion is free, and the "
                "plane never pushes."
            ),
        ),
        scene="free_motion_scene",
        until=Fraction(3),
    ),
    Exhibit(
        "pushed-particle",
        "examples/paper/paper.mac",
        (
            translatable("The same particle from the same place, but the plane is tilted evenly."),
            translatable("Now the plane has to push: the multiplier is not zero."),
        ),
        scene="initial_motion_scene",
        until=Fraction(3),
    ),
    Exhibit(
        "rocked-particle",
        "examples/paper/knob.mac",
        (
            translatable("The same once more, but the plane is rocked to and fro."),
            translatable("The multiplier changes its sign with every turn, and the particle slides off all the same."),
        ),
        scene="swinging_scene",
    ),
    Exhibit(
        "pendulum",
        "examples/pendulum.mac",
        (
            translatable(
                "The string is paid out: the bob swings to and fro on arcs that become wider, flatter and slower."
            ),
            translatable(
                "The multiplier is negative, for the string pulls and cannot push; it swings twice as often as the bob."
            ),
        ),
        scene="lengthening_scene",
        until=Fraction(20),
    ),
    Exhibit(
        "whirling-bob",
        "examples/whirling_bob.mac",
        (
            translatable(
                "The string is drawn in through the hole in the middle, and the bob whirls faster: positions at "
                "equal intervals of time lie further and further apart."
            ),
            translatable("The length falls evenly, the angle rises ever more steeply, and the pull grows most of all."),
        ),
    ),
    Exhibit(
        "prescribed-tension",
        "examples/prescribed_tension.mac",
        (
            translatable(
                "The winch holds the string to a tension instead of a length, and the bob goes in and out as it whirls."
            ),
            translatable(
                "The multiplier is a straight line, for it was prescribed; what was sought is the control, which has "
                "become a coordinate."
            ),
        ),
        scene="steady_scene",
    ),
    Exhibit(
        "winch",
        "examples/hoist.mac",
        (
            translatable(
                "A winch takes the rope up as it was recorded, every half second, and the load swings higher and "
                "faster."
            ),
            translatable("Between the recorded points the length is a spline, so that the pull has no steps."),
        ),
        scene="recorded_scene",
    ),
    Exhibit(
        "arm",
        "examples/arm.mac",
        (
            translatable("The tip of a two-link arm follows a circle."),
            translatable("Nothing pushes the tip: the last curves are the torques that the two motors must give."),
        ),
        scene="circle_scene",
    ),
    Exhibit(
        "overhead-crane",
        "examples/overhead_crane.mac",
        (
            translatable("The load of an overhead crane is carried to and fro while it is let down."),
            translatable(
                "Where the load is to go says where the rope points, and so what the trolley and the winch do."
            ),
        ),
    ),
    Exhibit(
        "lift",
        "examples/weightless_cabin.mac",
        (
            translatable("A passenger on the floor of a lift that starts upwards."),
            translatable("The floor presses evenly, and harder than the weight alone would ask for."),
        ),
        scene="lift_scene",
    ),
    Exhibit(
        "bead",
        "examples/bead.mac",
        (
            translatable(
                "The rod turns evenly and flings the bead out, while the slider at its foot is shaken to and fro."
            ),
            translatable(
                "The bead hardly feels the shaking. The multiplier, the force that drives the slider, grows with the "
                "distance of the bead."
            ),
        ),
        scene="driven_scene",
        until=Fraction(6, 5),
    ),
    Exhibit(
        "spherical-pendulum",
        "examples/spherical_pendulum.mac",
        (
            translatable(
                "A pendulum in space, with the plumb line under its bob, seen from above by one who turns with the "
                "hinge. The hinge is shaken and the bob goes through air: the path keeps to no plane."
            ),
            translatable("The multiplier swings with the bob, the more the wider that swings."),
        ),
    ),
    Exhibit(
        "crane",
        "examples/crane.mac",
        (
            translatable(
                "The motor pushes the trolley along its rail, and the load swings after it on a rope that is paid out "
                "and drawn in."
            ),
            translatable(
                "The load follows the trolley with a swing of its own; the multiplier is negative, for the rope pulls."
            ),
        ),
    ),
    Exhibit(
        "chain",
        "examples/chain.mac",
        (
            translatable(
                "A chain released on a straight line, its first link drawn in: at the turning point it begins to fold."
            ),
            translatable("The uppermost link carries most, each further one less."),
        ),
    ),
    Exhibit(
        "linkage",
        "examples/linkage.mac",
        (
            translatable(
                "A parallelogram turns over. Twice a revolution all rods are in line, where it might fold into another"
                " shape; it does not."
            ),
            translatable("The coordinates pass these places smoothly, with the robust engine at work."),
        ),
    ),
    Exhibit(
        "heavy-top",
        "examples/heavy_top.mac",
        (
            translatable(
                "A spinning top, its tip on a support that is shaken to and fro: the axis goes round the vertical, and"
                " nods as it is shaken."
            ),
            translatable(
                "Three multipliers are the force at the tip. The first belongs to |e| = 1 and acts on no body."
            ),
        ),
        until=Fraction(2),
    ),
    Exhibit(
        "satellite",
        "examples/satellite.mac",
        (
            translatable("A satellite runs out two masts with masses at their ends: it turns ever more slowly."),
            translatable("The forces on the masses fall, although the masts grow longer: the spin falls faster."),
        ),
        scene="slowed_scene",
    ),
    Exhibit(
        "ring",
        "examples/ring.mac",
        (
            translatable(
                "Three bars joined to a ring, free of forces. It turns in its plane at first, but one bar spins about "
                "its own axis, and turns the plane."
            ),
            translatable(
                "The first three multipliers belong to |e| = 1 and act on no body; the others are the components of "
                "the forces at the joints, which turn with the ring."
            ),
        ),
    ),
    Exhibit(
        "andrews",
        "examples/andrews.mac",
        (
            translatable(
                "The small crank on the right goes round and drags seven bodies along; the long line is the spring."
            ),
            translatable("The crank's angle runs up evenly at last, and the multipliers beat with its revolutions."),
        ),
    ),
    Exhibit(
        "car-axis",
        "examples/car_axis.mac",
        (
            translatable(
                "The right foot follows the bumps of the road, the left one stands on flat ground; between them the "
                "axle rides on two stiff springs."
            ),
            translatable("On the slow wave of the road lies the fast ringing of the springs."),
        ),
    ),
    Exhibit(
        "heavy-bob",
        "examples/hard/heavy_bob.mac",
        (
            translatable(
                "The lower mass is by far the heavier: it falls as if it were free, and pulls the light one along."
            ),
            translatable(
                "The multipliers are as small as the light mass, though the terms that they come from are as large as "
                "the heavy one."
            ),
        ),
    ),
    Exhibit(
        "repeated-constraint",
        "examples/hard/repeated_constraint.mac",
        (
            translatable(
                "A pendulum whose one constraint is given twice. Nothing of that is to be seen in its motion."
            ),
            translatable(
                "The second constraint follows from the first, whose multiplier carries the force; the other is put to "
                "zero."
            ),
        ),
    ),
    Exhibit(
        "sarrus-linkage",
        "examples/hard/sarrus_linkage.mac",
        (
            translatable(
                "Two pairs of hinged plates at right angles let the table go straight down and no other way, with one "
                "constraint more than it needs."
            ),
            translatable(
                "The table's corners fall alike. The multipliers are those that are zero for the redundant constraint."
            ),
        ),
    ),
    Exhibit(
        "bricard-linkage",
        "examples/hard/bricard_linkage.mac",
        (
            translatable(
                "Five bars and the ground along the edges of a cube, with six hinges. By the count of its constraints "
                "it should be rigid, and it falls."
            ),
            translatable(
                "The forces of the constraints are unique. The multipliers are those that are zero for the redundant "
                "constraint."
            ),
        ),
    ),
    Exhibit(
        "stiff-spring",
        "examples/hard/stiff_spring.mac",
        (
            translatable("A rod of growing length between a soft spring, on the left, and a stiff one."),
            translatable("The stiff spring rings so fast and so little that only the multiplier shows it."),
        ),
    ),
    Exhibit(
        "swing",
        "examples/hard/swing.mac",
        (
            translatable(
                "A swing on two rods. Their hinges are nearly together at first, the rods nearly one, and move apart."
            ),
            translatable(
                "The closer the hinges, the larger the two multipliers that have to share one force. One is positive: "
                "that rod pushes, which a rope could not."
            ),
        ),
    ),
    Exhibit(
        "vanishing-length",
        "examples/hard/vanishing_length.mac",
        (
            translatable("A pendulum drawn in to its hinge. The film stops shortly before the length is zero."),
            translatable(
                "Near the end the multiplier rises without bound: no finite force holds the bob to a vanishing length."
            ),
        ),
        until=Fraction(9, 10),
    ),
)


def chapter(root: Path) -> Chapter:
    """The chapter, with the examples under a root."""

    def page(results: Mapping[str, Motion]) -> Page:
        return Page(
            {"exhibits": [(exhibit, results[exhibit.name]) for exhibit in EXHIBITS]},
            figures=figures_of(results.items()),
            sources=tuple(dict.fromkeys(exhibit.file for exhibit in EXHIBITS)),
        )

    return Chapter(
        slug="gallery",
        title=translatable("Gallery"),
        aim=translatable("Every example in motion: how it looks, where it goes, and what its constraints have to do."),
        template="gallery.html",
        runs={each.name: motion(root / each.file, each.scene, each.until) for each in EXHIBITS},
        page=page,
    )
