"""A rigid body and the same body as two that are welded together: motions, reactions and equilibria are the same."""

import random
from fractions import Fraction

import pytest

import holonom

JOINTS = ("revolute_joint", "spherical_joint", "cylindrical_joint", "planar_joint", "point_on_line", "point_on_plane")
WHOLE = "B : rigid_body({mass}, {inertia}, [x, y, z], [e0, e1, e2, e3])$"
PARTS = """
B1 : rigid_body({masses[0]}, {inertias[0]}, [x1, y1, z1], [a0, a1, a2, a3])$
B2 : rigid_body({masses[1]}, {inertias[1]}, [x2, y2, z2], [b0, b1, b2, b3])$
weld : generic_joint({weld[0]}, {weld[1]}, [1, 2, 3], [1, 2, 3])$
"""
SCENE = """
load("holonom.mac")$
{bodies}
joint : {joint}({joined}, marker(ground, {place}, {axis}))$
system : holonomic_system(assembly({parts}, joint, spring(7, 1, {spring}, [3, 4, 5]), damper(1/2, {damper}, [-3, 4, 2]),
  uniform_gravity([1, 2, -3], {falling}), applied_torque([1/2, 1/3, 1], {turned})))$
run : holonomic_scene(system, time_span = [0, 1], initial_state = [{start}],
  observe = [P = position({spring}), V = velocity({damper}), R = reaction(joint)])$
"""


def text(numbers):
    return "[" + ", ".join(map(str, numbers)) + "]"


def both(seed):
    """Return scenes of the whole body and of its parts, at rest, and the shares of their masses."""
    draw = random.Random(seed)

    def places(count):
        return [[Fraction(draw.choice((-3, -1, 1, 3)), 2) for _ in range(3)] for _ in range(count)]

    masses = [draw.randint(1, 4) for _ in range(2)]
    inertias = [[draw.randint(3, 5) for _ in range(3)] for _ in range(2)]
    apart, joined, spring, damper, weld = places(5)
    shares = -Fraction(masses[1], sum(masses)), Fraction(masses[0], sum(masses))
    centres = [[share * x for x in apart] for share in shares]
    inertia = [
        [
            sum(
                (principal[i] + mass * sum(x * x for x in at) if i == j else 0) - mass * at[i] * at[j]
                for mass, principal, at in zip(masses, inertias, centres, strict=True)
            )
            for j in range(3)
        ]
        for i in range(3)
    ]
    axis, joint = draw.choice(([0, 0, 1], [0, 3, 4])), draw.choice(JOINTS)
    owners = [draw.randrange(2) for _ in range(3)]

    def marker(part, place, *directions):
        if part is None:
            return f"marker(B, {', '.join(map(text, [place, *directions]))})"
        own = [x - c for x, c in zip(place, centres[part], strict=True)]
        return f"marker(B{part + 1}, {', '.join(map(text, [own, *directions]))})"

    def scene(bodies, parts, falling, turned, start, owners):
        names = [*start, *(f"dot({name})" for name in start)]
        return holonom.system(
            SCENE.format(
                bodies=bodies,
                parts=parts,
                falling=falling,
                turned=turned,
                joint=joint,
                place=text(joined),
                axis=text(axis),
                joined=marker(owners[0], joined, axis),
                spring=marker(owners[1], spring),
                damper=marker(owners[2], damper),
                start=", ".join(f"{name} = {start.get(name, 0)}" for name in names),
            )
        )

    upright = dict(zip(("x", "y", "z", "e0", "e1", "e2", "e3"), (0, 0, 0, 1, 0, 0, 0), strict=True))
    matrix = f"matrix({', '.join(map(text, inertia))})"
    whole = scene(WHOLE.format(mass=sum(masses), inertia=matrix), "B", "B", "B", upright, [None] * 3)
    start = {f"{c}{k}": x for k, at in enumerate(centres, start=1) for c, x in zip("xyz", at, strict=True)}
    start |= {f"{e}{k}": int(k == 0) for e in "ab" for k in range(4)}
    welded = [marker(part, weld, [0, 0, 1]) for part in range(2)]
    bodies = PARTS.format(masses=masses, inertias=list(map(text, inertias)), weld=welded)
    parts = scene(bodies, "B1, B2, weld", "B1, B2", f"B{draw.randrange(2) + 1}", start, owners)
    return whole, parts, [Fraction(mass, sum(masses)) for mass in masses]


@pytest.mark.parametrize("seed", [*range(2), *(pytest.param(seed, marks=pytest.mark.long) for seed in range(2, 12))])
def test_motion_and_reactions_of_the_whole(seed):
    one, other = (scene.simulate(samples=3) for scene in both(seed)[:2])
    for name, size in (("P", 3), ("V", 3), ("R", 6)):
        for k in range(1, size + 1):
            assert other[f"{name}[{k}]"] == pytest.approx(one[f"{name}[{k}]"], abs=1e-9)


@pytest.mark.long
@pytest.mark.parametrize("seed", range(4))
def test_equilibria_of_the_whole(seed):
    """The weld allows half turns about its axes, too, but no motion makes them."""
    whole, parts, shares = both(seed)

    def states(found, centre):
        return sorted((*(round(centre(each.coordinates, c), 6) for c in "xyz"), each.stability) for each in found)

    expected = states(whole.equilibria(), lambda q, c: q[c])
    assert states(parts.equilibria(), lambda q, c: shares[0] * q[f"{c}1"] + shares[1] * q[f"{c}2"]) == expected
