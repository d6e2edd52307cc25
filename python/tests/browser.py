"""A report in headless Chromium, driven by selenium."""

from __future__ import annotations

import pathlib
from typing import Any

import pytest

import broadmark
from broadmark.report import write_report

webdriver = pytest.importorskip("selenium.webdriver", reason="Debian's python3-selenium is missing")
from selenium.webdriver.chrome.service import Service  # noqa: E402
from selenium.webdriver.common.by import By  # noqa: E402

CHROMEDRIVER = pathlib.Path("/usr/bin/chromedriver")
FLAGS = [
    *("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
]


class Page:
    """A report in the browser."""

    def __init__(self, driver: Any, folder: pathlib.Path) -> None:
        self.driver, self.folder = driver, folder

    def show(
        self, *paths: pathlib.Path, width: int = 1280, dark: bool = False, program_page: str = ""
    ) -> None:
        """Writes the report of results files and opens it; a width below 600 emulates a phone."""
        results = broadmark.read_results(*paths)
        self.show_results(results, width=width, dark=dark, program_page=program_page)

    def show_results(
        self,
        results: broadmark.Results,
        *,
        width: int = 1280,
        dark: bool = False,
        program_page: str = "",
    ) -> None:
        report = self.folder / "a report.html"
        write_report(results, report, pictures=False, program_page=program_page)
        size = {"width": width, "height": 900, "deviceScaleFactor": 1, "mobile": width < 600}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", size)
        colours = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [colours]})
        self.driver.get(report.as_uri())
        self.wait("return document.documentElement.dataset.ready")  # its scripts have run

    def section(self, name: str) -> Any:
        """Scrolls to a section, waits until it is drawn and returns it."""
        found = self.driver.find_element(By.ID, name)
        self.js("arguments[0].scrollIntoView()", found)
        self.wait(f"return document.querySelector('#{name} .body:not([aria-busy])')")
        return found

    def js(self, script: str, *arguments: Any) -> Any:
        return self.driver.execute_script(script, *arguments)

    def wait(self, script: str, *arguments: Any) -> Any:
        """Waits until a script, rerun after every change of the page, returns a true value."""
        return self.driver.execute_async_script(
            """
            const done = arguments[arguments.length - 1];
            const values = [...arguments].slice(1, -1);
            const script = new Function(arguments[0]);
            const observer = new MutationObserver(check);
            function check() {
              const found = script(...values);
              if (!found) return;
              observer.disconnect();
              done(found);
            }
            const changes = {subtree: true, childList: true, attributes: true, characterData: true};
            observer.observe(document, changes);
            check();
            """,
            script,
            *arguments,
        )

    def texts(self, selector: str) -> list[str]:
        script = "return [...document.querySelectorAll(arguments[0])].map((n) => n.textContent)"
        return list(self.js(script, selector))

    def find(self, selector: str) -> Any:
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def hover(self, element: Any) -> None:
        webdriver.ActionChains(self.driver).move_to_element(element).perform()

    def type(self, *keys: str) -> None:
        for key in keys:
            self.driver.switch_to.active_element.send_keys(key)

    def filter(self, name: str, *texts: str) -> None:
        """Selects only the given options of a filter."""
        menu = self.find(f'details.filter[data-filter="{name}"]')
        menu.find_element(By.TAG_NAME, "summary").click()
        menu.find_element(By.XPATH, ".//button[text()='none']").click()
        for text in texts:
            menu.find_element(By.XPATH, f".//label[span[text()='{text}']]").click()
        menu.find_element(By.TAG_NAME, "summary").click()

    def ratios(self, table: int = 0) -> dict[str, list[str]]:
        """The rows of a table of ratios: mean, gaps and a cell per recording."""
        self.section("ratios")
        self.wait("return document.querySelectorAll('table[role=grid]')[arguments[0]]", table)
        rows = self.js(
            "return [...document.querySelectorAll('table[role=grid]')[arguments[0]].tBodies[0].rows]"
            ".map((row) => [...row.cells].map((cell) => cell.textContent))",
            table,
        )
        return {name: cells for name, *cells in rows}


def start_browser(home: pathlib.Path) -> Any:
    """Starts Chromium with all its files in `home`."""
    if not CHROMEDRIVER.exists():
        pytest.skip("Debian's chromium-driver is missing")
    options = webdriver.ChromeOptions()
    for flag in [*FLAGS, f"--user-data-dir={home}/profile"]:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    folders = dict.fromkeys(("HOME", "XDG_CONFIG_HOME", "TMPDIR"), str(home))
    service = Service(str(CHROMEDRIVER), env={"PATH": "/usr/bin:/bin", **folders})
    driver = webdriver.Chrome(options=options, service=service)
    driver.set_script_timeout(24 * 3600)  # only the test's own time limit applies
    return driver
