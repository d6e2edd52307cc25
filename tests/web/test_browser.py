"""The inspector in a browser."""

import pytest
from conftest import REMOTE, Page


@pytest.fixture(params=["no threads", "no vectors"])
def plain_page(request, address):
    """A page on which the program runs on one thread, with scalar code."""
    if request.param == "no threads":
        opened = Page(address.replace("127.0.0.1", REMOTE), 1280, 800)
    else:
        opened = Page(address, 1280, 800, vectors=False)
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
        + ["--select", "3,14", "--camera", "0.1,0,-0.1,30,20,1.5"]
    )
    page.until("shown_frame", lambda frame: frame == "5")
    pairs = page.until("pairs", lambda pairs: pairs != "")
    page.driver.execute_script(
        "navigator.clipboard.writeText = (text) => { window.copied = text; return Promise.resolve() }"
    )
    page.press("File")
    page.press("File/Copy link")
    link = page.wait("window.copied")
    page.open(link.split("#")[1].split("&"))
    page.until("shown_frame", lambda frame: frame == "5")
    assert page.until("pairs", lambda found: found != "") == pairs
    assert page.value("bodies") == "200"
    assert page.value("selection") == "2"
    assert page.value("camera.yaw") == "0.5236"
    assert page.value("camera.distance") == "1.5000"
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
    page.driver.get(page.address + "index.html#--no-such-option")
    page.wait("document.getElementById('message').innerText.includes('--no-such-option')")


def test_without_threads_or_vectors_the_plain_program_runs(plain_page):
    page = plain_page
    page.open(["freefall", "--objects", "300", "--algorithm", "columns,tide", "--frame", "12"])
    page.until("shown_frame", lambda frame: frame == "12")
    assert page.value("missed") == "0"
    assert page.value("algorithm.columns.isa") == "scalar"
    assert "one thread" in page.driver.find_element("id", "limits").text
    page.press("Playback/Play")
    page.until("shown_frame", lambda frame: int(frame) > 30)
    page.press("Playback/Play")
    page.press("Duel")
    page.press("Duel/Start")
    page.until("duel.state", lambda state: state == "done")
    assert page.value("duel.verdict") != ""
    assert page.complaints() == []


def test_the_plain_program_finds_the_planted_fault(plain_page):
    plain_page.open()
    plain_page.press("Start/Find the bug")
    plain_page.until("missed", lambda missed: missed == "1")
    assert "c-sweep is wrong" in plain_page.value("status")
    assert plain_page.complaints() == []


def test_preferences_outlive_the_page(page):
    page.open()
    assert page.value("theme") == "dark"
    page.press("View")
    page.press("View menu/Light")
    page.wait("Object.values(localStorage).some((text) => text.includes('\"dark\": false'))")
    page.open()
    assert page.value("theme") == "light"
    assert page.complaints() == []


def test_memory_stays_the_same_while_playing(address):
    page = Page(address, 1280, 800)
    try:
        page.open(["freefall", "--objects", "500", "--frames", "60", "--algorithm", "columns,tide"])
        page.press("Playback/Loop")
        page.press("Playback/Play")
        minutes = "performance.now() > arguments[0] * 60e3 && Module.HEAPU8.length"
        early = page.wait(minutes, 2, patience=180)
        assert page.wait(minutes, 10, patience=600) == early
    finally:
        page.driver.quit()
