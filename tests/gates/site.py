#!/usr/bin/env python3
"""Tests the handbook's site in a browser: `site.py build/docs/html`. No page may write to the console or send requests
to another host. Pages must follow the browser's choice of light or dark, and nothing may be wider than a phone. Search
results must not contain TeX."""

import contextlib
import functools
import http.server
import json
import pathlib
import re
import sys
import threading
import time

from selenium import webdriver

WIDTHS = (360, 1440)
PAGES = ("index.html", "reference/keys.html", "explanation/statistics.html", "gallery/notebook.html",
         "search.html?q=probability")
LOADED_FROM = re.compile(r'<(?:script|img|link rel="stylesheet")[^>]*\b(?:src|href)="(?:https?:)?//[^"]*"')


class Quiet(http.server.SimpleHTTPRequestHandler):
    """Serves the site without log messages."""

    def log_message(self, *_):
        pass


@contextlib.contextmanager
def served(folder):
    """Serves the folder. @return the address"""
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=folder)) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


@contextlib.contextmanager
def browser(scheme):
    options = webdriver.ChromeOptions()
    for option in ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage"):
        options.add_argument(option)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options)
    try:
        driver.execute_cdp_cmd("Emulation.setEmulatedMedia",
                               {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
        yield driver
    finally:
        driver.quit()


def wait_for(driver, condition):
    """Waits until a script returns true, but at most half a minute. If the script never returns true, later checks
    fail."""
    end = time.monotonic() + 30
    while not driver.execute_script(f"return !!({condition})") and time.monotonic() < end:
        time.sleep(0.1)


def requests(driver):
    """The addresses that the page has requested."""
    for entry in driver.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            yield message["params"]["request"]["url"]


def faults_of_page(driver, address, page, width, scheme):
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                           {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 500})
    driver.get(f"{address}/{page}")
    wait_for(driver, "document.readyState == 'complete'")
    if page.startswith("search"):
        wait_for(driver, "/matching/.test(document.body.innerText) && document.querySelector('.search li .context')")
    elif driver.execute_script("return [...document.scripts].some((script) => /mathjax/i.test(script.src))"):
        wait_for(driver, "window.MathJax && document.querySelector('.MathJax, .mjx-chtml, .MathJax_CHTML')")
    yield from (entry["message"] for entry in driver.get_log("browser") if entry["level"] in ("WARNING", "SEVERE"))
    yield from (f"asks {asked}" for asked in requests(driver)
                if not asked.startswith((address, "data:", "about:", "blob:")))
    if (wide := driver.execute_script("return document.documentElement.scrollWidth")) > width:
        yield f"is {wide} pixels wide"
    red = driver.execute_script("return Number(getComputedStyle(document.body).backgroundColor.match(/[0-9]+/)[0])")
    if (red < 128) != (scheme == "dark"):
        yield "has the background of the other colour scheme"
    if not driver.execute_script("return [...document.querySelectorAll('.theme-toggle')].some((button) => "
                                 "button.getClientRects().length)"):
        yield "has no button for light and dark"
    if "\\(" in driver.execute_script("return document.querySelector('[role=main]').innerText"):
        yield "shows TeX"


def faults(site):
    for page in sorted(site.rglob("*.html")):
        if "api" not in page.relative_to(site).parts and (found := LOADED_FROM.search(page.read_text())):
            yield f"{page.relative_to(site)}: {found[0]}"
    with served(site) as address:
        for scheme in ("light", "dark"):
            with browser(scheme) as driver:
                for page in PAGES:
                    for width in WIDTHS:
                        yield from (f"{page}, {width} pixels, {scheme}: {fault}"
                                    for fault in faults_of_page(driver, address, page, width, scheme))


def main():
    found = list(faults(pathlib.Path(sys.argv[1])))
    print("\n".join(found))
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
