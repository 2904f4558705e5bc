"""What a reader meets on a page: measured by the browser that shows it."""

import json
from base64 import b64decode
from dataclasses import dataclass
from pathlib import Path

from selenium.webdriver import Chrome
from views import View

MEASURES = Path(__file__).with_name("measures.js").read_text(encoding="utf-8")
MUST_HAVE_NAMES = ("link", "image", "heading", "navigation", "region", "DisclosureTriangle")


@dataclass(frozen=True)
class Observation:
    """Facts about one page; the lists of faults name their elements."""

    page: Path
    messages: list[str]  # of the console
    requests: list[str]  # addresses of all that was loaded
    headings: list[int]  # levels, as assistive technology is told
    nameless: list[str]  # what assistive technology can announce by its role only
    wider: list[str]  # reaches over the page's edge
    cut_off: list[str]  # holds more than it shows, and does not scroll
    out_of_reach: list[str]  # scrolls, but not by the keyboard
    idle_stops: list[str]  # the keyboard stops there, and nothing scrolls
    off_screen: list[str]  # formulas that reach beyond the screen
    towering: list[str]  # formulas taller than most screens, and not folded
    fonts: list[str]  # loaded by the page
    flat_mathematics: list[str]
    broken_mathematics: list[str]
    empty_pictures: list[str]
    pale: list[str]  # text of less contrast than WCAG 2.2 wants at level AA
    links: list[str]
    names: list[str]  # that links can aim at


def observe(driver: Chrome, page: Path, view: View) -> Observation:
    """Show a page, unfold all of it, and measure."""
    view.take(driver)
    _clear_logs(driver)
    driver.get(page.as_uri())
    measured = driver.execute_script(MEASURES, view.width)
    return Observation(page, _messages(driver), _requests(driver), *_announced(driver), **measured)


def keep_screenshot(driver: Chrome, file: Path) -> None:
    """Write what the browser shows, the whole page from head to foot."""
    picture = driver.execute_cdp_cmd(
        "Page.captureScreenshot", {"captureBeyondViewport": True, "optimizeForSpeed": True}
    )
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_bytes(b64decode(picture["data"]))


def _clear_logs(driver: Chrome) -> None:
    driver.get_log("browser")
    driver.get_log("performance")


def _messages(driver: Chrome) -> list[str]:
    return [entry["message"] for entry in driver.get_log("browser")]


def _requests(driver: Chrome) -> list[str]:
    events = [json.loads(entry["message"])["message"] for entry in driver.get_log("performance")]
    return [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]


def _announced(driver: Chrome) -> tuple[list[int], list[str]]:
    nodes = [node for node in driver.execute_cdp_cmd("Accessibility.getFullAXTree", {})["nodes"] if not node["ignored"]]
    levels = [_property(node, "level") for node in nodes if node["role"]["value"] == "heading"]
    named = [node["role"]["value"] for node in nodes if not node.get("name", {}).get("value", "").strip()]
    return levels, [role for role in named if role in MUST_HAVE_NAMES]


def _property(node: dict, name: str) -> int:
    return next(each["value"]["value"] for each in node["properties"] if each["name"] == name)
