"""The ways in which a page is looked at."""

from dataclasses import dataclass

from selenium.webdriver import Chrome


@dataclass(frozen=True)
class View:
    """A screen or a sheet of paper; width and height in CSS pixels, 96 to the inch."""

    name: str
    width: int
    height: int
    mobile: bool = False
    colours: str = "light"
    medium: str = "screen"

    def __str__(self) -> str:
        return self.name

    def take(self, driver: Chrome) -> None:
        """Let the browser show its pages in this view."""
        size = {"width": self.width, "height": self.height, "deviceScaleFactor": 1, "mobile": self.mobile}
        colours = [{"name": "prefers-color-scheme", "value": self.colours}]
        driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": self.medium, "features": colours})


PHONE, PHONE_IN_THE_DARK = (View(f"phone, {colours}", 360, 740, True, colours) for colours in ("light", "dark"))
DESK, DESK_IN_THE_DARK = (View(f"desk, {colours}", 1280, 900, colours=colours) for colours in ("light", "dark"))
PAPER = View("paper", 680, 960, medium="print")  # what A4 leaves between margins of 15 mm
VIEWS = (PHONE, PHONE_IN_THE_DARK, DESK, DESK_IN_THE_DARK, PAPER)
