"""Tests the page of a sweep in a browser, as a reader uses it."""

import base64
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

from PIL import Image
from selenium import webdriver
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.support.ui import WebDriverWait

from support import BIN, LONGEST, ROOT, SMALL, ProgramTest, shared_sweep

sys.path.insert(1, str(ROOT / "analysis"))
from clogsweep.pages import chart  # noqa: E402
from clogsweep.tools import rounded  # noqa: E402

SECONDS = 120  # long enough for a busy machine
POINT = "svg.chart .point"


def setUpModule():
    """Starts one browser for all tests, because starting a browser takes seconds."""
    options = webdriver.ChromeOptions()
    # Shared memory is small in a container, and the sandbox does not work for root.
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--window-size=1280,900"):
        options.add_argument(argument)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    Browser.browser = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
    unittest.addModuleCleanup(Browser.browser.quit)
    Browser.browser.set_page_load_timeout(SECONDS)


class Browser(ProgramTest):
    """Tests one page. Each test of a class loads this page again."""

    KEYS: list[str]  # keys of the sweep
    browser: webdriver.Chrome

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="clog_page_")
        cls.addClassCleanup(folder.cleanup)
        cls.page = pathlib.Path(folder.name) / "page.html"
        sweep = shared_sweep(*cls.KEYS)
        printed = subprocess.run([BIN / "clogfit", sweep, "--format", "json"], check=True, capture_output=True, text=True,
                                 timeout=LONGEST)
        cls.groups = json.loads(printed.stdout)["groups"]
        subprocess.run([BIN / "clogfit", "report", sweep, "--output", cls.page, "--examples", "1"], check=True,
                       capture_output=True, timeout=LONGEST)

    def setUp(self):
        super().setUp()
        self.see("light")
        self.browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": False})

    def see(self, scheme):
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                     {"features": [{"name": "prefers-color-scheme", "value": scheme}]})

    def read_page(self):
        self.browser.get(self.page.as_uri())
        self.point_at(self.find("h1"))  # Another test may have left the mouse elsewhere.

    def point_at(self, element):
        ActionChains(self.browser).move_to_element(element).perform()

    def wait(self, condition):
        WebDriverWait(self.browser, SECONDS, poll_frequency=0.05).until(lambda _: condition())

    def find_all(self, selector):
        return self.browser.find_elements(By.CSS_SELECTOR, selector)

    def find(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def column(self, heading):
        """The cells of a column from top to bottom."""
        titles = [title.text for title in self.find_all("th")]
        return [cell.text for cell in self.find_all(f"tbody td:nth-child({titles.index(heading) + 1})")]

    def shown(self):
        """The texts of the card beside the mouse, by the headings of the card."""
        self.wait(self.find("#card").is_displayed)
        terms = [[element.text for element in self.find_all(f"#card {name}")] for name in ("dt", "dd")]
        return dict(zip(*terms, strict=True))

    def background(self):
        return self.browser.execute_script("return getComputedStyle(document.body).backgroundColor")


class Lengths(Browser):
    KEYS = [*SMALL, "max-time=200", "line-tension=0.1,0.7,3", "obstacle-gap=0.3,0.4", "seeds=1..4"]

    def group(self, gap, tension):
        found, = [group for group in self.groups if (group["obstacle_gap"], group["line_tension"]) == (gap, tension)]
        return found

    def test_nothing_is_loaded_and_nothing_fails(self):
        for log in ("browser", "performance"):
            self.browser.get_log(log)  # discards earlier messages
        self.read_page()
        self.assertEqual(self.browser.get_log("browser"), [])
        events = [json.loads(entry["message"])["message"] for entry in self.browser.get_log("performance")]
        asked = [event["params"]["request"]["url"] for event in events if event["method"] == "Network.requestWillBeSent"]
        self.assertEqual([url for url in asked if not url.startswith("data:")], [self.page.as_uri()])

    def test_a_point_shows_the_numbers_of_clogfit(self):
        self.read_page()
        first_chart = self.find("svg.chart")
        points = first_chart.find_elements(By.CSS_SELECTOR, ".point")
        self.assertEqual(len(points), len(self.groups))
        for point in points:
            self.point_at(point)
            shown = self.shown()
            group = self.group(float(shown["obstacle gap"]), float(shown["line tension"]))
            length, lower, upper = (group[f"clogging_length{end}"] for end in ("", "_lower", "_upper"))
            self.assertEqual(shown["λ/σ (95 %)"], rounded.with_interval(length, lower, upper) if group["clogs"] else f"> {rounded.plain(lower)}")
            occurring = {name for name in ("wrapped", "squeezed", "hybrid", "other") if any(one[name] for one in self.groups)}
            self.assertEqual({name: shown[name] for name in shown if name in ("wrapped", "squeezed", "hybrid", "other")}, {name: str(group[name]) for name in occurring})
            for name in ("runs", "clogs"):
                self.assertEqual(shown[name], str(group[name]))
            self.assertEqual(shown["seeds"], "1 to 4")
            # Few runs clogged, so the card contains clogfit's sentence about few clogs.
            self.assertIn("more droplets are needed", shown["doubts"])
            # Only the curve of this point is bright in the legend.
            bright = first_chart.find_elements(By.CSS_SELECTOR, ".legend.of")
            self.assertEqual(len(bright), 1)
            self.assertIn(point.get_attribute("data-groups"), bright[0].get_attribute("data-groups").split())
            self.assertEqual({row.get_attribute("data-groups") for row in self.find_all("tr.of")},
                             {point.get_attribute("data-groups")})
        self.point_at(self.find("h1"))
        self.wait(lambda: not self.find("#card").is_displayed())
        self.assertEqual(self.find_all(".of"), [])

    def test_a_keyboard_goes_from_point_to_point(self):
        self.read_page()
        points = self.find_all(POINT)
        self.browser.execute_script("arguments[0].focus()", points[0])
        first = self.shown()
        ActionChains(self.browser).send_keys(Keys.TAB).perform()
        self.assertEqual(self.browser.switch_to.active_element, points[1])
        second = self.shown()
        self.assertNotEqual(first, second)
        for point, shown in ((points[0], first), (points[1], second)):
            self.assertIn(f"line tension {shown['line tension']}: length {shown['λ/σ (95 %)']},",
                          point.get_attribute("aria-label"))
        ActionChains(self.browser).send_keys(Keys.ESCAPE).perform()
        self.wait(lambda: not self.find("#card").is_displayed())

    def test_a_heading_sorts_by_numbers(self):
        self.read_page()
        heading, = [title for title in self.find_all("th") if title.text == "λ/σ (95 %)"]
        name = heading.text

        def lengths():
            return [float(re.match(r"(?:> )?(\S+)", cell)[1]) for cell in self.column(name)]

        before = lengths()
        self.assertNotEqual(before, sorted(before))
        heading.find_element(By.TAG_NAME, "button").click()
        self.assertEqual(heading.get_attribute("aria-sort"), "ascending")
        self.assertEqual(lengths(), sorted(before))
        self.browser.switch_to.active_element.send_keys(Keys.ENTER)
        self.assertEqual(heading.get_attribute("aria-sort"), "descending")
        self.assertEqual(lengths(), sorted(before, reverse=True))
        # After the table was sorted, each point must still show its own row.
        self.point_at(self.find_all(POINT)[0])
        self.assertIn(self.shown()[name], self.find_all(POINT)[0].get_attribute("aria-label"))

    def test_the_heading_of_a_long_table_stays_in_sight(self):
        self.read_page()
        self.browser.execute_script("document.querySelector('.scroll').style.maxHeight = '6rem'; "
                                    "document.querySelector('.scroll').scrollTop = 1000")
        box, heading = (self.find(selector).rect for selector in (".scroll", "th"))
        self.assertGreater(self.browser.execute_script("return document.querySelector('.scroll').scrollTop"), 0)
        self.assertAlmostEqual(heading["y"], box["y"], delta=1)

    def colours_of_picture(self):
        """The number of pixels of each brightness in the first chart, as the browser shows it."""
        (self.folder / "chart.png").write_bytes(base64.b64decode(self.find("svg.chart").screenshot_as_base64))
        with Image.open(self.folder / "chart.png") as picture:
            return picture.convert("L").histogram()

    def test_light_and_dark_are_followed(self):
        self.read_page()
        self.assertEqual(self.background(), "rgb(255, 255, 255)")
        counts = self.colours_of_picture()
        self.assertEqual(counts.index(max(counts)), 255)
        self.assertGreater(sum(counts[:80]), 500, "dark ink")
        self.see("dark")
        self.wait(lambda: self.background() == f"rgb{chart.DARK_PAPER}")
        counts = self.colours_of_picture()
        self.assertLess(counts.index(max(counts)), 40)
        self.assertGreater(sum(counts[160:]), 500, "light ink")

    def test_a_narrow_screen_needs_no_scrolling_to_the_side(self):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                     {"width": 400, "height": 800, "deviceScaleFactor": 1, "mobile": True})
        self.addCleanup(self.browser.execute_cdp_cmd, "Emulation.clearDeviceMetricsOverride", {})
        self.read_page()
        self.assertLessEqual(self.browser.execute_script("return document.documentElement.scrollWidth"), 400)
        for point in self.find_all(POINT)[:len(self.groups)]:
            self.point_at(point)
            self.shown()
            card = self.find("#card").rect
            self.assertTrue(card["x"] >= 0 and card["x"] + card["width"] <= 400, card)

    def test_without_a_script_every_number_is_there(self):
        self.browser.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
        self.read_page()
        self.assertEqual(self.find_all("button"), [])
        self.assertEqual([float(gap) for gap in self.column("obstacle gap")],
                         [group["obstacle_gap"] for group in self.groups])
        self.assertEqual(self.column("clogs"), [str(group["clogs"]) for group in self.groups])
        for point, title in zip(self.find_all(POINT), self.find_all(f"{POINT} > title"), strict=True):
            self.assertEqual(point.get_attribute("aria-label"), title.get_attribute("textContent"))
        self.assertGreater(sum(self.colours_of_picture()[:80]), 500)


class Passages(Browser):
    KEYS = ["orifice=0.7", "vertices=64", "line-tension=0.3,5", "start=-1.5", "end=1", "max-time=2000"]

    def test_a_point_shows_its_passage(self):
        self.read_page()
        outcomes = set()
        for number, point in enumerate(self.find_all(POINT)[:2]):
            self.point_at(point)
            shown = self.shown()
            self.assertEqual((shown["line tension"], shown["outcome"]),
                             (f"{self.groups[number]['line_tension']:g}", self.groups[number]["status"]))
            self.assertEqual(shown["largest A"], f"{self.groups[number]['largest_shape_parameter']:.4g}")
            outcomes.add(shown["outcome"])
        self.assertEqual(outcomes, {"passed", "clogged"})


class Colours(unittest.TestCase):
    def test_every_colour_can_be_seen_in_the_dark(self):
        self.assertEqual([chart.in_the_dark((grey,) * 3) for grey in (0, 255)], [chart.DARK_INK, chart.DARK_PAPER])
        for colour in ((0x44, 0x01, 0x54), (0, 0x72, 0xB2), (0xD5, 0x5E, 0)):
            light = chart.luminance(chart.in_the_dark(colour))
            self.assertGreaterEqual((light + 0.05) / (chart.luminance(chart.DARK_PAPER) + 0.05), chart.LEAST_CONTRAST)
        bright = (0xFD, 0xE7, 0x25)
        self.assertEqual(chart.in_the_dark(bright), bright)


if __name__ == "__main__":
    unittest.main()
