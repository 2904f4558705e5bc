"""The heading of a scene on the console."""

from ..hidden import visible_line


def heading(scene: str, title: str) -> str:
    """Return the heading of a scene: its name, and its title if it has one.

    Parameters
    ----------
    scene, title : str
        Name and title of the scene.

    Returns
    -------
    str
        One line without control characters.
    """
    return visible_line(scene if title == scene else f"{scene}: {title}")
