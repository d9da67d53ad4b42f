"""Draws in the studio as a person does, by mouse and by keyboard; runs of what is saved are the same."""

import json
import time
import zipfile
from collections.abc import Callable
from pathlib import Path

from browser import picture, resize
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import Select
from studio_page import Studio, same_as_program

ROOT = Path(__file__).resolve().parent.parent


def starts_empty(studio: Studio) -> None:
    """An empty floor, whose name is new."""
    studio.js("studio.open('start')")
    before = studio.js("return studio.document.name ?? null")
    start = studio.ask("start")
    studio.click("#start-empty")
    studio.until(lambda: studio.js("return studio.mode") == "draw")
    name = studio.js("return studio.document.name")
    assert name not in [before, *(one["name"] for one in start["drawings"] + start["runs"])], (name, start)


def draws_by_mouse(studio: Studio, folder: Path) -> None:
    """A room with a door and an exit, drawn by mouse; 100 people leave it, while the door closes and opens."""
    starts_empty(studio)
    studio.picture("empty")
    studio.draws("room", (0, 0), (12, 8))
    studio.draws("wall", (8, 0), (8, 8))
    studio.draws("door", (8, 3.5), (8, 4.5))
    studio.draws("exit", (12, 3), (12, 5))
    studio.draws("crowd", (0.5, 0.5), (7.5, 7.5))
    studio.fills("#field-crowds-0-number", "100")
    document = studio.js("return studio.document")
    assert [len(document[key]) for key in ["walkable_area", "doors", "exits", "crowds"]] == [1, 1, 1, 1], document
    assert document["crowds"][0]["number"] == 100, document["crowds"]
    assert studio.checked() is None, studio.checked()
    studio.picture("drawn")
    ActionChains(studio.driver).key_down(Keys.CONTROL).send_keys(Keys.ENTER).key_up(Keys.CONTROL).perform()
    studio.until(lambda: studio.js("return studio.mode === 'play' && Boolean(studio.player?.isShown)"))
    studio.until(lambda: studio.state()["playing"])
    door = "#gates tr[data-kind=door] button"
    is_open = lambda: next(one["open"] for one in studio.state()["doors"] if one["kind"] == "door")
    studio.until(lambda: studio.state()["time"] > 2)
    studio.click(door)
    studio.until(lambda: not is_open())
    studio.until(lambda: studio.state()["time"] > 5)
    studio.picture("closed")
    studio.click(door)
    studio.until(is_open)
    Select(studio.find("#speed")).select_by_value("Infinity")
    studio.until(lambda: studio.state()["people"] == 0)
    studio.stops()
    passed = {one["name"]: one["passed"] for one in studio.state()["doors"]}
    assert set(passed.values()) == {100}, passed
    same_as_program(studio, folder)


def draws_by_keyboard(studio: Studio, folder: Path) -> None:
    """The same by keys alone: a room, an exit, a crowd, play, push, stop."""
    studio.js("studio.open('start'); document.activeElement.blur()")

    studio.tab_to("#start-empty")
    studio.press(Keys.ENTER)
    studio.until(lambda: studio.js("return studio.mode") == "draw")
    studio.tab_to("#draw-svg")

    def typed(key: str, *places: str) -> None:
        studio.press(key)
        for place in places:
            studio.press(*place, Keys.ENTER)

    # Coordinates; the first corner closes an area.
    typed("r", "0;0", "10;6")
    assert studio.text("#draw-place") == "10, 6 m", studio.text("#draw-place")
    typed("e", "10;2", "10;4")
    typed("c", "1;1", "6;1", "6;5", "1;5", "1;1")
    document = studio.js("return studio.document")
    assert [len(document.get(key, [])) for key in ["walkable_area", "exits", "crowds"]] == [1, 1, 1], document
    assert studio.checked() is None, studio.checked()
    # Another number of people, by the list of elements and its form.
    studio.tab_to("#field-crowds-0-number")
    studio.press(*[Keys.BACKSPACE] * 4, "25", Keys.TAB)
    assert studio.js("return studio.document.crowds[0].number") == 25
    ActionChains(studio.driver).key_down(Keys.CONTROL).send_keys(Keys.ENTER).key_up(Keys.CONTROL).perform()
    studio.until(lambda: studio.js("return studio.mode === 'play' && Boolean(studio.player?.isShown)"))
    studio.until(lambda: studio.state()["playing"] and studio.state()["people"] == 25)
    studio.tab_to("#top")
    studio.press(" ")
    studio.until(lambda: not studio.state()["playing"])
    studio.press("r")
    studio.press(*[Keys.ARROW_LEFT] * 2, Keys.ENTER)
    studio.tab_to("#gates button")
    studio.press(Keys.ENTER)
    studio.until(lambda: studio.state()["done"] >= 1)
    studio.tab_to("#top")
    studio.press(Keys.ARROW_RIGHT)

    def choose() -> None:
        studio.tab_to("#save summary")
        studio.press(Keys.ENTER)
        studio.tab_to("#save-json")
        studio.press(Keys.ENTER)

    same_as_program(studio, folder, choose)


def takes_a_barrier_away(studio: Studio, folder: Path) -> None:
    """People stand before a barrier from wall to wall until it is opened while they play."""
    starts_empty(studio)
    studio.draws("room", (0, 0), (12, 4))
    studio.draws("barrier", (7, 0), (7, 4))
    studio.draws("exit", (12, 0), (12, 4))
    studio.draws("crowd", (0.5, 0.5), (6, 3.5))
    studio.fills("#field-crowds-0-number", "40")
    assert studio.checked() is None, studio.checked()
    studio.click("#draw-play")
    studio.until(lambda: studio.js("return studio.mode === 'play' && Boolean(studio.player?.isShown)"))
    Select(studio.find("#speed")).select_by_value("Infinity")
    studio.until(lambda: studio.state()["time"] > 12)
    # Nobody has passed it; 40 people in the first seven meters.
    places = "const all = []; studio.player.people.each(x => all.push(x + studio.player.scene.origin[0])); return all"
    assert max(studio.js(places)) <= 7 and studio.state()["people"] == 40, studio.state()
    studio.click("#gates tr[data-kind=door] button")
    studio.until(lambda: studio.state()["people"] == 0)
    studio.stops()
    same_as_program(studio, folder)
    studio.click("#edit")
    assert "before 1 change made while" in studio.text("#message"), studio.text("#message")


def keeps_drawings(studio: Studio) -> None:
    """A drawing of a tab that was closed right after its last change is on the start page, and goes on."""
    driver, own = studio.driver, studio.driver.current_window_handle
    driver.switch_to.new_window("tab")
    resize(driver, 1920, 1080)
    driver.get(studio.address)
    studio.until(lambda: studio.js("return Boolean(globalThis.studio?.drawing.sheet)"))
    studio.click("#start-empty")
    studio.until(lambda: studio.js("return studio.mode") == "draw")
    studio.draws("room", (0, 0), (6, 5))
    studio.fills("#name", "my own room")
    drawn = studio.js("return studio.document")
    assert drawn["name"] == "my own room" and len(drawn["walkable_area"]) == 1, drawn
    driver.close()
    driver.switch_to.window(own)
    studio.js("studio.open('draw')")
    before = studio.js("return studio.document")
    studio.js("studio.open('start')")
    link = lambda: next((one for one in driver.find_elements(By.CSS_SELECTOR, "#drawings li")
                         if one.text.startswith("my own room")), None)
    said = studio.until(lambda: (found := link()) and found.text)
    assert "1 element, changed less than a minute ago" in said, said
    studio.picture("start-again")

    def goes_on() -> bool:
        found = link()
        if found:
            found.find_element(By.CSS_SELECTOR, "button.link").click()
        return bool(found)

    studio.until(goes_on)
    studio.until(lambda: studio.js("return studio.mode") == "draw")
    assert studio.js("return studio.document") == drawn
    # What was drawn here before is not lost either, and nothing is listed twice.
    names = studio.until(lambda: [one["name"] for one in studio.ask("start")["drawings"]])
    studio.until(lambda: [one["name"] for one in studio.ask("start")["drawings"]].count("my own room") == 1)
    assert before.get("name") in names, (names, before)
    # A reload keeps it under its key.
    key = studio.js("return studio.drawing.key")
    driver.refresh()
    studio.until(lambda: studio.js("return document.body.dataset.state") == "ready")
    assert studio.js("return [studio.document, studio.drawing.key]") == [drawn, key]


def imports(studio: Studio, folder: Path) -> None:
    """A scenario of JuPedSim's web app, and a drawing of CAD."""
    app = folder / "hall.zip"
    rectangle = lambda a, b: [[a[0], a[1]], [b[0], a[1]], [b[0], b[1]], [a[0], b[1]], [a[0], a[1]]]
    config = {
        "project_version": "2.0",
        "config": {"simulation_settings": {"baseSeed": 7, "numberOfSimulations": 1, "simulationParams":
            {"max_simulation_time": 40, "model_type": "CollisionFreeSpeedModel"}}},
        "exits": {"jps-exits_0": {"type": "polygon", "coordinates": rectangle([18, 0], [20, 10])}},
        "distributions": {"jps-distributions_0": {"type": "polygon", "coordinates": rectangle([1, 1], [7, 9]),
            "parameters": {"number": 30, "radius": 0.2, "v0": 1.3}}},
    }
    with zipfile.ZipFile(app, "w") as archive:
        archive.writestr("config.json", json.dumps(config))
        archive.writestr("geometry.wkt", "POLYGON ((0 0, 20 0, 20 10, 0 10, 0 0))")
    for file, least in [(app, 1), (ROOT / "tests/data/dxf/office.dxf", 1)]:
        document = studio.imports(file)
        assert studio.js("return studio.mode") == "draw" and len(document["walkable_area"]) >= least, document
        assert studio.checked() is None, studio.checked()
        shapes = studio.js("return studio.drawing.shapes.length")
        assert shapes >= 2, shapes
        studio.picture(f"import-{file.stem}")


def shows_problems(studio: Studio) -> None:
    """Twenty wrong drawings: the message of each stands at its element, and leads to it."""
    square = [[0, 0], [10, 0], [10, 6], [0, 6]]
    fine = {"name": "wrong", "walkable_area": [[square]], "exits": [{"name": "out", "line": [[10, 2], [10, 4]]}],
            "crowds": [{"name": "all", "area": [[1, 1], [5, 1], [5, 5], [1, 5]], "number": 10}]}
    wrong = [
        ("crowds[0]", {"crowds": [{**fine["crowds"][0], "number": 900}]}),
        ("crowds[0]", {"crowds": [{**fine["crowds"][0], "number": 0}]}),
        ("crowds[0]", {"crowds": [{**fine["crowds"][0], "number": 1.5}]}),
        ("crowds[0]", {"crowds": [{**fine["crowds"][0], "density": -1, "number": None}]}),
        ("crowds[0]", {"crowds": [{**fine["crowds"][0], "profile": "steer"}]}),
        ("crowds[0]", {"crowds": [{**fine["crowds"][0], "journey": "none"}]}),
        ("crowds[0]", {"crowds": [{**fine["crowds"][0], "area": [[20, 1], [25, 1], [25, 5], [20, 5]]}]}),
        ("crowds[0]", {"crowds": [{**fine["crowds"][0], "area": [[1, 1], [5, 5], [5, 1], [1, 5]]}]}),
        ("crowds[0]", {"crowds": [{**fine["crowds"][0], "preferred_speed": {"normal": {"mean": 1}}}]}),
        ("exits[0]", {"exits": [{"name": "out", "line": [[30, 2], [30, 4]]}]}),
        ("exits[0]", {"exits": [{"name": "out", "line": [[10, 2], [10, 2]]}]}),
        ("exits[0]", {"exits": [{"name": "", "line": [[10, 2], [10, 4]]}]}),
        ("exits[0]", {"exits": [{"name": "out", "line": [[10, 2], [10, 4]], "most_per_sec": 0}]}),
        ("doors[0]", {"doors": [{"name": "out", "line": [[5, 0], [5, 6]]}]}),
        ("doors[0]", {"doors": [{"name": "door", "line": [[30, 0], [30, 6]]}]}),
        ("zones[0]", {"zones": [{"area": square, "speed_factor": 0}]}),
        ("zones[0]", {"zones": [{"area": [[0, 0], [1, 1]], "speed_factor": 1}]}),
        ("walkable_area[0]", {"walkable_area": [[[[0, 0], [10, 6], [10, 0], [0, 6]]]]}),
        ("obstacles[0]", {"obstacles": [[[2, 2], [4, 4], [4, 2], [2, 4]]]}),
        ("agents[0]", {"agents": [{"position": [50, 50], "goal": [5, 5]}]}),
    ]
    for path, change in wrong:
        document = {**fine, **change}
        studio.js("studio.edit(arguments[0])", json.loads(json.dumps(document)))
        problem = studio.until(lambda: studio.js("return studio.drawing.problem"))
        assert problem["path"].startswith(path), (path, problem)
        shown = studio.text("#draw-problem")
        assert problem["reason"][:40] in shown, (shown, problem)
        marked = studio.js("return document.querySelector('#draw-list .wrong')?.dataset.path ?? null")
        assert marked and marked.startswith(path), (path, marked, problem)
        studio.click("#draw-problem")
        assert studio.js("return studio.drawing.selected?.text ?? null").startswith(path), path
    studio.picture("problem")
    # A wrong drawing is not played; once it is mended, the message goes.
    studio.click("#draw-play")
    time.sleep(0.5)
    assert studio.js("return studio.mode") == "draw"
    studio.js("studio.edit(arguments[0])", fine)
    assert studio.checked() is None
    shown = studio.text("#draw-problem")
    assert shown.startswith("Ready to play, 10 people at the start."), shown


def draws_people_as_typed(studio: Studio) -> None:
    """A small crowd has as many people as find room, and says so; a number that was typed is kept."""
    starts_empty(studio)
    studio.draws("room", (0, 0), (12, 8))
    studio.draws("crowd", (1, 1), (4, 3))
    assert studio.js("return studio.document.crowds[0].number") == 15
    assert studio.text("#draw-hint") == "15 people find room here; type another number in the form."
    studio.checked()
    assert studio.text("#draw-hint").startswith("15 people"), "the check of the program leaves the hint"
    studio.click("#draw-crowd")
    studio.fills("#draw-number", "400")
    studio.draws("crowd", (6, 1), (9, 3))
    assert studio.js("return studio.document.crowds[1].number") == 400
    studio.draws("exit", (12, 3), (12, 5))
    problem = studio.checked()
    assert problem["path"].startswith("crowds[1]"), problem
    assert studio.text("#draw-problem").startswith("crowd 2: "), studio.text("#draw-problem")
    studio.click("#draw-crowd")
    studio.fills("#draw-number", "50")


def keeps_the_plan_still(studio: Studio) -> None:
    """Neither tools nor hints, problems, notes and messages move the plan."""
    box = """const { left, top, width, height } = document.getElementById('draw-svg').getBoundingClientRect();
        return [left, top + scrollY, width, height]"""
    starts_empty(studio)
    studio.draws("room", (0, 0), (12, 8))
    for width, height in [(1920, 1080), (800, 1000)]:
        resize(studio.driver, width, height)
        time.sleep(0.4)
        before = studio.js(box)
        for tool in studio.js("return Object.keys(PENCILS)"):
            studio.click(f"#draw-{tool}")
            assert studio.js(box) == before, (width, tool, studio.js(box), before)
        for text in ["", "one line", "several lines " * 40]:
            studio.js("studio.drawing.say(arguments[0]); studio.say(arguments[0])", text)
            found = {"problem": {"path": "", "reason": text, "message": text}, "notes": []}
            for shown in [found, {"problem": None, "notes": [text] * 5, "people": 3}]:
                studio.js("studio.drawing.showFound(arguments[0])", shown)
                assert studio.js(box) == before, (width, text, studio.js(box), before)
    studio.js("studio.say('')")
    resize(studio.driver, 1920, 1080)


def traces_an_image(studio: Studio, folder: Path) -> None:
    """An image that is opened on the start page lies beneath the drawing, gets its scale and is traced."""
    starts_empty(studio)
    is_said = lambda: studio.find("#draw-empty").is_displayed()
    said, plan = studio.find("#draw-empty").rect, studio.find("#draw-plan").rect
    assert is_said() and said["y"] > plan["y"] + 0.7 * plan["height"], (said, plan)
    studio.draws("floor", (1, 1), (1, 1))
    studio.until(lambda: not is_said())
    studio.press(Keys.ESCAPE)
    studio.until(is_said)
    picture(studio.driver, folder / "plan.png")
    studio.js("studio.open('start')")
    studio.find("#file").send_keys(str(folder / "plan.png"))
    studio.until(lambda: studio.js("return studio.mode === 'draw' && studio.drawing.underlay.isMeasuring"))
    studio.until(lambda: not is_said())
    marks = lambda: studio.js("return document.querySelectorAll('.spot.scale').length")
    # The clicks are points of the image, whichever tool is chosen.
    places = [(5.13, 5.21), (9.13, 5.21)]
    for count, place in enumerate(places):
        studio.draws("room", place, place)
        studio.until(lambda: marks() == [1, 3][count])
    points = studio.js("return studio.drawing.underlay.points")
    pixel = 1 / studio.js("return studio.drawing.scale")
    assert all(abs(a - b) < pixel for own, place in zip(points, places) for a, b in zip(own, place)), points
    studio.picture("scale")
    before = studio.js("return studio.drawing.underlay.pixel")
    studio.find("#image-meters").send_keys("8", Keys.ENTER)
    studio.until(lambda: marks() == 0)
    factor = studio.js("return studio.drawing.underlay.pixel") / before
    assert abs(factor - 8 / (points[1][0] - points[0][0])) < 1e-9, factor
    # Corners of the image lie nowhere on the grid.
    studio.draws("wall", (2.3, 3.33), (7.1, 3.33))
    step = studio.js("return studio.drawing.sheet.step")
    (low, high) = sorted({y for _, y in studio.js("return studio.document.obstacles[0]")})
    middle = (low + high) / 2 / step
    assert abs(10 * middle - round(10 * middle)) < 1e-6 < abs(middle - round(middle)), (low, high, step)
    assert "Alt: no snapping" in studio.text("#draw-hint"), studio.text("#draw-hint")
    studio.click("#image-remove")


def shows_places_and_notes(studio: Studio) -> None:
    """A problem without an element on the plan names its key and stands at its place; notes have another color."""
    rooms = [[[[x, 0], [x + 6, 0], [x + 6, 6], [x, 6]]] for x in (0, 10)]
    fine = {"name": "apart", "walkable_area": rooms, "exits": [{"name": "out", "line": [[16, 2], [16, 4]]}],
            "crowds": [{"area": [[11, 1], [15, 1], [15, 5], [11, 5]], "number": 5}],
            "labels": [{"text": "hall", "at": [60, 60]}]}
    wrong = {**fine, "journeys": [{"name": "way", "stages": ["out"]}],
             "crowds": [{"area": [[1, 1], [5, 1], [5, 5], [1, 5]], "number": 5, "journey": "way"}]}
    studio.js("studio.edit(arguments[0])", wrong)
    problem = studio.until(lambda: studio.js("return studio.drawing.problem"))
    shown, place = studio.text("#draw-problem"), studio.js("return studio.drawing.wrongPlace")
    assert shown == f"{problem['path']}: {problem['reason']}" and problem["path"] == "journeys", (shown, problem)
    assert place and 1 <= place[0] <= 5 and 1 <= place[1] <= 5, problem
    assert studio.find("#draw-mark").is_displayed() and studio.find(".spot.wrong").is_displayed()
    studio.picture("place")
    studio.js("studio.drawing.sheet.moveBy(-5000, 0)")
    studio.click("#draw-problem")
    x = studio.js("return studio.drawing.sheet.toSheet(arguments[0])[0]", place)
    width = studio.js("return studio.drawing.sheet.width")
    assert 0 < x < width, (x, width)
    studio.js("studio.edit(arguments[0])", fine)
    assert studio.checked() is None, studio.checked()
    assert studio.find("#draw-problem").get_attribute("class") == "noted", studio.text("#draw-problem")
    assert "Note: hall, at: (60, 60)" in studio.text("#draw-problem"), studio.text("#draw-problem")
    studio.picture("noted")
