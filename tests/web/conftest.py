"""The site of scripts/build-web in Chromium, without a window.

The server sends no special headers, as most do: the pages make themselves isolated.
"""

import functools
import http.server
import os
import pathlib
import threading

import pytest
from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.actions.action_builder import ActionBuilder
from selenium.webdriver.common.actions.pointer_input import PointerInput
from selenium.webdriver.support.wait import WebDriverWait

ROOT = pathlib.Path(__file__).resolve().parents[2]
SITE = pathlib.Path(os.environ.get("BROADMARK_SITE", ROOT / "build/web/site"))
REMOTE = "broadmark.test"  # another host's pages have no threads without https
PATIENCE = 120  # seconds; a software renderer draws


class QuietHandler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class Page:
    def __init__(self, address, width, height, touch=False, vectors=True):
        options = webdriver.ChromeOptions()
        for argument in (
            "--headless=new",
            "--no-sandbox",
            "--use-gl=angle",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
            f"--host-resolver-rules=MAP {REMOTE} 127.0.0.1",
        ):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        if touch:
            metrics = {"width": width, "height": height, "pixelRatio": 2.0}
            options.add_experimental_option("mobileEmulation", {"deviceMetrics": metrics})
        self.driver = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
        if not touch:
            self.driver.set_window_size(width, height)
        if not vectors:
            self.driver.execute_cdp_cmd(
                "Page.addScriptToEvaluateOnNewDocument",
                {"source": "WebAssembly.validate = () => false"},
            )
        self.touch = touch
        self.address = address

    def open(self, arguments=()):
        self.driver.get("about:blank")  # another hash alone would load nothing
        self.driver.get(self.address + "index.html#" + "&".join(arguments))
        self.until("frame", lambda frame: frame != "")

    def wait(self, script, *values, patience=PATIENCE):
        """Waits until a script returns a true value, and returns it."""
        wait = WebDriverWait(self.driver, patience, 0.2)
        return wait.until(lambda driver: driver.execute_script("return " + script, *values), script)

    def value(self, name):
        return self.driver.execute_script(
            "return window.Module?.ccall && Module.calledRun"
            " ? Module.ccall('broadmarkValue', 'string', ['string'], arguments) : ''",
            name,
        )

    def until(self, name, is_right):
        seen = []
        WebDriverWait(self.driver, PATIENCE, 0.2).until(
            lambda _: seen.append(self.value(name)) or is_right(seen[-1]),
            f"{name} is not as expected",
        )
        return seen[-1]

    def press(self, widget):
        places = []
        WebDriverWait(self.driver, PATIENCE, 0.2).until(
            lambda driver: places.append(
                driver.execute_script(
                    "return Module.ccall('broadmarkPlace', 'string', ['string'], arguments)",
                    widget,
                )
            )
            or places[-1],
            f"{widget} is not in view",
        )
        scale = self.driver.execute_script("return devicePixelRatio")
        x, y = (float(number) / scale for number in places[-1].split())
        pointer = PointerInput("touch" if self.touch else "mouse", "pointer")
        actions = ActionBuilder(self.driver, mouse=pointer)
        actions.pointer_action.move_to_location(x, y)
        actions.pointer_action.pointer_down()
        actions.pointer_action.pause(0.3)  # a picture sees it
        actions.pointer_action.pointer_up()
        actions.perform()

    def drag(self, begin, end):
        """Drags the pointer from one place to another, in CSS pixels."""
        pointer = PointerInput("touch" if self.touch else "mouse", "pointer")
        actions = ActionBuilder(self.driver, mouse=pointer)
        actions.pointer_action.move_to_location(*begin)
        actions.pointer_action.pointer_down()
        actions.pointer_action.move_to_location(*end)
        actions.pointer_action.pointer_up()
        actions.perform()

    def complaints(self):
        return [
            entry["message"]
            for entry in self.driver.get_log("browser")
            if entry["level"] in ("SEVERE", "WARNING") and "GPU stall" not in entry["message"]
        ]


@pytest.fixture(scope="session")
def address():
    handler = functools.partial(QuietHandler, directory=SITE)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/"
    server.shutdown()


@pytest.fixture(params=[(1280, 800, False), (390, 844, True)], ids=["laptop", "phone"])
def page(request, address):
    opened = Page(address, *request.param)
    yield opened
    opened.driver.quit()
