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


# Widths and colours are independent of each other: each of both is looked at once.
PHONE = View("phone in the dark", 360, 740, mobile=True, colours="dark")
DESK = View("desk", 1280, 900)
PAPER = View("paper", 680, 960, medium="print")  # what A4 leaves between margins of 15 mm
VIEWS = (PHONE, DESK, PAPER)
