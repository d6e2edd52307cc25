"""The program in a browser: the site of scripts/build-web, in Chromium without a window.

The server sends no special headers, as most do: the page makes itself isolated.
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
PATIENCE = 120  # seconds; a software renderer draws


class Page:
    def __init__(self, address, width, height, touch=False):
        options = webdriver.ChromeOptions()
        for argument in (
            "--headless=new",
            "--no-sandbox",
            "--use-gl=angle",
            "--use-angle=swiftshader",
            "--enable-unsafe-swiftshader",
        ):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        if touch:
            metrics = {"width": width, "height": height, "pixelRatio": 2.0}
            options.add_experimental_option("mobileEmulation", {"deviceMetrics": metrics})
        self.driver = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
        if not touch:
            self.driver.set_window_size(width, height)
        self.touch = touch
        self.address = address

    def open(self, arguments=()):
        self.driver.get("about:blank")  # another hash alone would load nothing
        self.driver.get(self.address + "#" + "&".join(arguments))
        self.until("frame", lambda frame: frame != "")

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

    def complaints(self):
        return [
            entry["message"]
            for entry in self.driver.get_log("browser")
            if entry["level"] in ("SEVERE", "WARNING") and "GPU stall" not in entry["message"]
        ]


@pytest.fixture(scope="module")
def address():
    handler = functools.partial(http.server.SimpleHTTPRequestHandler, directory=SITE)
    handler.log_message = lambda *_: None
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    yield f"http://127.0.0.1:{server.server_port}/index.html"
    server.shutdown()


@pytest.fixture(params=[(1280, 800, False), (390, 844, True)], ids=["laptop", "phone"])
def page(request, address):
    opened = Page(address, *request.param)
    yield opened
    opened.driver.quit()


def test_finds_the_planted_fault(page):
    page.open()
    assert page.value("start_page") == "yes"
    assert page.driver.execute_script("return crossOriginIsolated")
    page.press("Start/Find the bug")
    page.until("missed", lambda missed: missed == "1")
    assert "c-sweep is wrong" in page.value("status")
    assert page.complaints() == []


def test_the_address_holds_a_session(page):
    page.open(["freefall", "--objects", "300", "--algorithm", "columns,tide", "--frame", "12"])
    page.until("shown_frame", lambda frame: frame == "12")
    assert page.value("bodies") == "300"
    assert page.value("algorithms") == "2"
    page.until("missed", lambda missed: missed == "0")
    assert page.value("error") == ""
    assert page.complaints() == []


def test_a_link_opens_the_same_session(page):
    page.open(
        ["gravity", "--objects", "200", "--param", "seed=7", "--algorithm", "kd", "--frame", "5"]
    )
    page.until("shown_frame", lambda frame: frame == "5")
    pairs = page.until("pairs", lambda pairs: pairs != "")
    page.driver.execute_script(
        "navigator.clipboard.writeText = (text) => { window.copied = text; return Promise.resolve() }"
    )
    page.press("File")
    page.press("File/Copy link")
    link = WebDriverWait(page.driver, PATIENCE, 0.2).until(
        lambda driver: driver.execute_script("return window.copied")
    )
    page.open(link.split("#")[1].split("&"))
    page.until("shown_frame", lambda frame: frame == "5")
    assert page.until("pairs", lambda found: found != "") == pairs
    assert page.value("bodies") == "200"
    assert page.complaints() == []


def test_a_dropped_recording_opens(page):
    page.open(["freefall", "--objects", "50", "--frames", "9", "--frame", "9"])
    page.until("shown_frame", lambda frame: frame == "9")
    header = (b"Dropped".ljust(128, b"\0"), b"Cubes".ljust(128, b"\0"))
    page.driver.execute_script(
        """
        const boxes = new Float32Array([0,0,0,0, 4,4,4,0,  0,0,0,0, 1,1,1,0,  1,1,1,0, 2,2,2,0]);
        const counts = new Int32Array([2, 1, 0, 0]);
        const frame = boxes.slice(8);
        const parts = [...arguments[0].map(name => new Uint8Array(name)), counts.slice(0, 3),
                       new Int32Array(1), boxes, frame];
        const data = new DataTransfer();
        data.items.add(new File(parts, "dropped.aabbs"));
        const event = new DragEvent("drop", {bubbles: true, cancelable: true});
        Object.defineProperty(event, "dataTransfer", {value: data});
        document.getElementById("canvas").dispatchEvent(event);
        """,
        [list(part) for part in header],
    )
    page.until("bodies", lambda bodies: bodies == "2")
    assert page.value("error") == ""


def test_a_bad_address_is_explained(page):
    page.driver.get(page.address + "#--no-such-option")
    WebDriverWait(page.driver, PATIENCE, 0.2).until(
        lambda driver: "--no-such-option"
        in driver.execute_script("return document.getElementById('message').innerText")
    )
