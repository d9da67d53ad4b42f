"""Plays in the studio: the plan stays where it is, and what is shown of an earlier time is of that time."""

import time
from pathlib import Path

from browser import messages, resize
from selenium.webdriver.common.keys import Keys
from studio_page import Studio

TOOLS = ["push", "add", "remove", "goal", "hand"]
GATE = "#gates tr[data-kind=door]"
GATED = {
    "name": "gated", "walkable_area": [[[[0, 0], [16, 0], [16, 6], [0, 6]]]], "duration_secs": 100,
    "exits": [{"name": "out", "line": [[16, 1], [16, 5]]}], "doors": [{"name": "gate", "line": [[8, 0], [8, 6]]}],
    "crowds": [{"name": "all", "area": [[1, 1], [7, 1], [7, 5], [1, 5]], "number": 30}],
}


def keeps_the_plan_of_a_run_still(studio: Studio) -> None:
    """Neither tools nor what is said move the plan or give the page another scrollbar."""
    studio.plays(name="evacuation")
    studio.until(lambda: studio.state()["time"] > 1)
    studio.stops()
    measure = """const { x, y, width, height } = document.getElementById('top').getBoundingClientRect();
        return [x, y + scrollY, width, height]"""
    for width, height in [(1920, 1080), (1400, 900), (1200, 800), (800, 1000)]:
        resize(studio.driver, width, height)
        time.sleep(0.4)
        before = studio.js(measure)

        def is_still(what: str) -> None:
            time.sleep(0.1)
            after = studio.js(measure)
            assert after == before, (width, what, before, after)
            if width > 900:
                tall = studio.js("return document.documentElement.scrollHeight")
                assert tall <= height, (width, what, tall)

        for tool in TOOLS:
            studio.click(f"#tool-{tool}")
            is_still(tool)
        # The digest of the width before is the same.
        studio.js("document.getElementById('digest').textContent = ''")
        studio.digest()
        is_still("digest")
        for line in ["message", "hint", "said", "event", "going", "digest"]:
            fill = "document.getElementById(arguments[0]).textContent = 'a long text '.repeat(arguments[1])"
            studio.js(fill, line, 40)
            is_still(line)
            studio.js(fill, line, 0)
        studio.js("studio.player.seek(0.5)")
        assert studio.find("#looking").is_displayed()
        is_still("looking back")
        # It covers nothing, and its buttons stand beside each other.
        tops = studio.js("""const box = id => document.getElementById(id).getBoundingClientRect();
            return [box('looking').top - box('plan').bottom, box('goback').top - box('return').top]""")
        assert tops[0] >= 0 and tops[1] == 0, tops
        for step in ["#back", "#forth"]:
            assert studio.find(step).is_displayed(), (width, step)
        studio.click("#return")
    resize(studio.driver, 1920, 1080)


def looks_back(studio: Studio) -> None:
    """Doors at an earlier time are those of that time; charts end where the run was set back to."""
    seek = "studio.player.seek(arguments[0])"
    gate = """return [document.querySelector(arguments[0]).classList.contains('closed'),
        studio.player.scene.above.some(({ text }) => text === 'door gate (closed)')]"""
    is_drawn = lambda closed: studio.until(lambda: studio.js(gate, GATE) == [closed, closed], 10)
    studio.plays(GATED)
    for secs in [1, 3]:
        studio.until(lambda: studio.state()["time"] > secs)
        studio.click(f"{GATE} button")
    studio.until(lambda: studio.state()["time"] > 5)
    studio.stops()
    is_drawn(False)
    closes, opens = [studio.js("return studio.player.run.events.find(([, text]) => text === arguments[0])[0]", text)
                     for text in ["gate closes", "gate opens"]]
    for secs, closed in [((closes + opens) / 2, True), (closes / 2, False), (opens + 0.5, False),
                         (opens - 0.2, True)]:
        studio.js(seek, secs)
        is_drawn(closed)
        studio.until(lambda: studio.text("#doors-at") == f"at {studio.text('#clock')}", 10)
        assert not studio.find(f"{GATE} button").is_enabled()
    studio.picture("back")
    shown = studio.js("return studio.player.time")
    assert shown in studio.js("return studio.player.run.times"), shown
    studio.click("#goback")
    studio.until(lambda: studio.js("return studio.player.run.newest") == shown)
    # The charts are drawn anew without a further wait: once more, they are the same.
    charts = "return [...document.querySelectorAll('#plots canvas')].map(canvas => canvas.toDataURL())"
    ends, drawn = studio.js("return studio.player.plots.ends"), studio.js(charts)
    assert ends[1] == shown, (ends, shown)
    studio.js("studio.player.plots.draw()")
    assert studio.js(charts) == drawn, "the charts show more than there is"
    is_drawn(True)
    assert studio.text("#doors-at") == "" and studio.find(f"{GATE} button").is_enabled()


def keeps_the_space_bar(studio: Studio) -> None:
    """After clicks the space bar plays; what was reached by Tab is pressed by it."""
    studio.plays(GATED)
    studio.stops()
    playing = lambda: studio.state()["playing"]
    is_unfolded = lambda: studio.js("return document.getElementById('parameters').open")
    for button in ["#parameters summary", f"{GATE} button", "#tool-push", "#back"]:
        studio.click(button)
        studio.press(" ")
        studio.until(playing, 10)
        studio.press(" ")
        studio.until(lambda: not playing(), 10)
    assert is_unfolded()
    studio.js("document.getElementById('whole').focus()")
    studio.tab_to("#parameters summary")
    studio.press(" ")
    studio.until(lambda: not is_unfolded(), 10)
    assert not playing()


def says_why_not(studio: Studio, folder: Path) -> None:
    """Refusals are sentences; a saved scenario says where it ends."""
    studio.is_clean()
    studio.js("studio.player.control({ to: -1 })")
    studio.until(lambda: studio.text("#reason") == "Give a time in seconds, from 0 on.")
    # The browser reports the refused request, too.
    messages(studio.driver)
    studio.click("#dismiss")
    end = studio.js("return String(Number(studio.player.run.state.time.toFixed(3)))")
    studio.saved(folder)
    studio.until(lambda: f"it ends at {end} s, now" in studio.text("#said"))


def plays_well(studio: Studio, folder: Path) -> None:
    """All of these."""
    keeps_the_plan_of_a_run_still(studio)
    looks_back(studio)
    keeps_the_space_bar(studio)
    says_why_not(studio, folder)
