"""Films of motions as files, and the choice of curves: formats, frames, and what is refused."""

import shutil
import subprocess
import warnings
from xml.etree import ElementTree

import numpy as np
import pytest
from click.testing import CliRunner
from PIL import Image

import holonom
from holonom.cli import holonom as command
from holonom.failures import ErrorKind, HolonomError
from holonom.figures.motion import motion_figure

PENDULUM = """
rod : planar_body(m, 1, [x, y], phi)$
hinge : revolute_joint(marker(rod, [-1, 0]), [0, 0])$
system : holonomic_system(parameters = [m], assembly(rod, hinge, gravity = uniform_gravity(10, rod)){drawing})$
swing : holonomic_scene(system, title = "A < B", parameter_values = [m = 1], time_span = [0, 1],
  initial_state = [phi = 0, dot(phi) = 0, x = 1, y = 0], observe = [{observe}, energy, R = reaction(hinge)])$
"""


def pendulum(observe="trajectory, multipliers", drawing=""):
    return holonom.system(PENDULUM.format(observe=observe, drawing=drawing))


def failure_of(act):
    with pytest.raises(HolonomError) as refused:
        act()
    return refused.value.kind


@pytest.fixture(scope="module")
def motion():
    return pendulum().simulate(samples=11)


def test_a_film_of_bodies_and_joints_needs_no_drawing(motion, tmp_path):
    motion.film().save(tmp_path / "film.svg")
    root = ElementTree.parse(tmp_path / "film.svg").getroot()
    assert root.tag.endswith("svg")
    assert any(each.tag.endswith("animate") for each in root.iter())
    motion.film().save(tmp_path / "film.html")
    page = (tmp_path / "film.html").read_text(encoding="utf-8")
    assert "<title>A &lt; B</title>" in page
    assert (tmp_path / "film.svg").read_text(encoding="utf-8") in page


def test_a_gif_has_a_frame_for_each_time(motion, tmp_path):
    for name in ("film.gif", "again.gif"):
        motion.film().save(tmp_path / name)
    with Image.open(tmp_path / "film.gif") as image:
        assert image.n_frames == len(motion.film().film.times) == 11
        first = np.array(image.convert("RGB"))
        image.seek(10)
        assert (np.array(image.convert("RGB")) != first).any()
    assert (tmp_path / "film.gif").read_bytes() == (tmp_path / "again.gif").read_bytes()


def test_a_film_of_a_point_at_rest_has_a_size(tmp_path):
    """Matplotlib warned of limits that are equal."""
    rotor = "system : holonomic_system(parameters = [J], assembly(rotor(J, phi)))$"
    scene = "scene : holonomic_scene(system, parameter_values = [J = 1], initial_state = [phi = 0, dot(phi) = 1])$"
    with warnings.catch_warnings(action="error"):
        holonom.system(rotor + scene).simulate(until=1, samples=2).film().save(tmp_path / "film.gif")


def test_motions_without_a_picture_are_refused(motion, tmp_path):
    assert failure_of(lambda: motion.film().save(tmp_path / "film.avi")) is ErrorKind.NO_SUCH_FORMAT
    uneven = pendulum().simulate(until=1)
    assert failure_of(uneven.film) is ErrorKind.NOT_FILMED
    unseen = pendulum(observe="multipliers").simulate(samples=5)
    assert failure_of(unseen.film) is ErrorKind.NOT_FILMED


def test_a_film_in_mp4_needs_ffmpeg(motion, tmp_path, monkeypatch):
    monkeypatch.setattr("shutil.which", lambda program: None)
    assert failure_of(lambda: motion.film().save(tmp_path / "film.mp4")) is ErrorKind.NO_FFMPEG


@pytest.mark.skipif(shutil.which("ffmpeg") is None, reason="ffmpeg is not installed")
def test_an_mp4_has_a_frame_for_each_time(motion, tmp_path):
    motion.film().save(tmp_path / "film.mp4")
    decoding = ["ffmpeg", "-i", str(tmp_path / "film.mp4"), "-f", "framemd5", "-"]
    decoded = subprocess.run(decoding, capture_output=True, text=True, check=True, stdin=subprocess.DEVNULL).stdout
    frames = [line.rpartition(",")[2] for line in decoded.splitlines() if not line.startswith("#")]
    assert len(frames) == len(set(frames)) == 11


def labels(figure):
    return [[text.get_text() for text in axes.get_legend().get_texts()] for axes in figure.axes]


def test_all_panels_have_a_legend_and_one_is_the_energy(motion):
    drawn = labels(motion_figure(motion))
    assert ["R[1]", "R[2]", "R[3]"] in drawn
    assert ["λ₁ (hinge)", "λ₂ (hinge)"] in drawn
    assert ["energy"] in [[name for name in panel if name == "energy"] for panel in drawn]
    assert all(drawn)


def test_curves_are_chosen_by_name(motion):
    assert labels(motion.plot(["R[1]", "y", "energy"]).figure) == [["y"], ["R[1]"], ["energy"]]
    assert failure_of(lambda: motion.plot(["z"])) is ErrorKind.NO_CURVE
    assert failure_of(lambda: motion.plot([])) is ErrorKind.NO_CURVE


def test_the_command_draws_and_films(tmp_path, write_scene):
    scene = write_scene('load("holonom.mac")$' + PENDULUM.format(observe="trajectory", drawing=""))
    files = ["--plot", str(tmp_path / "plot.svg"), "--curves", "x,R[2]", "--film", str(tmp_path / "film.svg")]
    asked = ["simulate", str(scene), "--samples", "11", *files]
    assert CliRunner().invoke(command, asked, standalone_mode=False).exception is None
    text = (tmp_path / "plot.svg").read_text(encoding="utf-8")
    assert ">R[2]<" in text
    assert ">R[1]<" not in text
    assert "<animate" in (tmp_path / "film.svg").read_text(encoding="utf-8")
