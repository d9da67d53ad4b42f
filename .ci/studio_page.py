"""The studio in a real browser, for the tests: the program, its page, and what a person does there."""

import json
import subprocess
import time
import urllib.request
from collections.abc import Callable
from pathlib import Path
from typing import Any

from browser import messages, picture, requested, resize
from selenium import webdriver
from selenium.common.exceptions import StaleElementReferenceException
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.ui import WebDriverWait


class Studio:
    """The program, and its page in the browser."""

    def __init__(self, sandbox: Path, driver: webdriver.Chrome, pictures: Path | None, *words: object):
        self.sandbox, self.driver, self.pictures = sandbox, driver, pictures
        command = [sandbox, "studio", "--no-browser", "--json", *map(str, words)]
        self.program = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        assert self.program.stdout is not None
        self.address = json.loads(self.program.stdout.readline())["address"]
        resize(driver, 1920, 1080)
        requested(driver)
        driver.get(self.address)
        self.until(lambda: self.js("return Boolean(globalThis.studio)"))

    def js(self, script: str, *values: object) -> Any:
        return self.driver.execute_script(script, *values)

    def until(self, is_there: Callable[[], Any], secs: float = 60) -> Any:
        # Lists are made again while they are read.
        ignored = [StaleElementReferenceException]
        wait = WebDriverWait(self.driver, secs, poll_frequency=0.05, ignored_exceptions=ignored)
        return wait.until(lambda _: is_there())

    def find(self, selector: str) -> Any:
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def click(self, selector: str) -> None:
        self.find(selector).click()

    def text(self, selector: str) -> str:
        return self.find(selector).text

    def ask(self, path: str) -> Any:
        with urllib.request.urlopen(self.address + path) as answer:
            return json.load(answer)

    def state(self) -> Any:
        return self.js("return studio.player.run.state")

    def run(self) -> str:
        return f"runs/{self.js('return studio.player.run.id')}"

    def plays(self, document: dict | None = None, name: str = "") -> None:
        """Plays a document, or an example."""
        document = document or self.ask(f"example?name={name}")["document"]
        before = self.js("return studio.player?.run.id ?? null")
        self.js("studio.play(arguments[0])", document)
        shown = """return studio.mode === 'play' && Boolean(studio.player?.isShown)
            && studio.player.run.id !== arguments[0]"""
        self.until(lambda: self.js(shown, before))

    def stops(self) -> None:
        """Stops the run."""
        self.js("studio.player.control({ play: false })")
        self.until(lambda: not self.state()["playing"])

    def on_plan(self, x: float, y: float) -> tuple[int, int]:
        """A place of the scenario in pixels from the middle of the plan."""
        script = """const { plan, scene } = studio.player, [ox, oy] = scene.origin;
            const [x, y] = plan.toScreen([arguments[0] - ox, arguments[1] - oy]);
            return [x - plan.width / 2, y - plan.height / 2]"""
        return tuple(round(value) for value in self.js(script, x, y))

    def drag(self, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Drags on the plan of a run from a place to another."""
        top = self.find("#top")
        steps = ActionChains(self.driver, duration=20).move_to_element_with_offset(top, *self.on_plan(*start))
        steps.click_and_hold().move_to_element_with_offset(top, *self.on_plan(*end)).release().perform()

    def on_sheet(self, x: float, y: float) -> tuple[int, int]:
        """A place of the drawing in pixels from the middle of the sheet."""
        script = """const box = document.getElementById('draw-svg').getBoundingClientRect();
            const [x, y] = studio.drawing.toScreen([arguments[0], arguments[1]]);
            return [x - box.left - box.width / 2, y - box.top - box.height / 2]"""
        return tuple(round(value) for value in self.js(script, x, y))

    def draws(self, tool: str, *places: tuple[float, float]) -> None:
        """Takes a tool by its button and drags from place to place on the drawing."""
        self.click(f"#draw-{tool}")
        sheet = self.find("#draw-svg")
        steps = ActionChains(self.driver, duration=20).move_to_element_with_offset(sheet, *self.on_sheet(*places[0]))
        steps.click_and_hold()
        for place in places[1:]:
            steps.move_to_element_with_offset(sheet, *self.on_sheet(*place))
        steps.release().perform()

    def fills(self, field: str, value: str) -> None:
        """Types a value into a field."""
        found = self.find(field)
        found.clear()
        found.send_keys(value, Keys.TAB)

    def imports(self, file: Path) -> dict:
        """Opens a file as by the file chooser; the drawing."""
        self.js("studio.drawing.document.imported = true")
        self.find("#file").send_keys(str(file))
        self.until(lambda: not self.js("return studio.document.imported ?? false"))
        return self.js("return studio.document")

    def checked(self) -> Any:
        """What the program says of the drawing."""
        time.sleep(0.5)
        return self.until(lambda: self.js("return { problem: studio.drawing.problem }"))["problem"]

    def somebody(self) -> tuple[float, float]:
        """The place of the person that is the farthest to the left."""
        return tuple(self.js("""let found = [Infinity, 0];
            studio.player.people.each((x, y) => { if (x < found[0]) found = [x, y]; });
            const [ox, oy] = studio.player.scene.origin;
            return [found[0] + ox, found[1] + oy]"""))

    def press(self, *keys: str) -> None:
        ActionChains(self.driver).send_keys(*keys).perform()

    def saved(self, folder: Path, choose: Callable[[], None] | None = None) -> Path:
        """The scenario with what was done, saved by the menu of the page: by mouse, or as `choose` does."""
        before = set(folder.glob("*.json"))
        if choose:
            choose()
        else:
            self.click("#save summary")
            self.click("#save-json")
        file = self.until(lambda: next(iter(set(folder.glob("*.json")) - before), None))
        self.until(lambda: file.read_text().strip().endswith("}"))
        return file

    def tab_to(self, selector: str) -> None:
        """Reaches an element by the Tab key."""
        for _ in range(300):
            if self.js("return document.activeElement.matches(arguments[0])", selector):
                return
            self.press(Keys.TAB)
        raise AssertionError(f"Tab does not reach {selector}")

    def digest(self) -> str:
        """The digest that the page shows."""
        self.click("#check")
        return self.until(lambda: self.text("#digest")).split()[1]

    def picture(self, name: str) -> None:
        """Pictures of a wide and of a narrow window, in which nothing reaches beyond the window."""
        for width, height in [(1920, 1080), (800, 1000)]:
            resize(self.driver, width, height)
            time.sleep(0.4)
            wide = self.js("return document.documentElement.scrollWidth")
            assert wide <= width, f"{name}: {wide} pixels wide in a window of {width}"
            if self.pictures:
                picture(self.driver, self.pictures / f"studio-{name}-{width}.png")
        resize(self.driver, 1920, 1080)

    def is_clean(self) -> None:
        """Fails if there was a message, or a request for another server."""
        told = messages(self.driver)
        assert not told, told
        others = {one for one in requested(self.driver) if not one.startswith((self.address, "data:", "blob:"))}
        assert not others, others

    def close(self) -> None:
        self.driver.get("about:blank")
        self.program.terminate()
        self.program.wait()


def result(sandbox: Path, file: Path) -> Any:
    """What the program reports of a scenario."""
    done = subprocess.run([sandbox, "run", file, "--json"], check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


def same_as_program(studio: Studio, folder: Path, choose: Callable[[], None] | None = None) -> None:
    """A run of what is saved gives the digest that the page shows."""
    found = studio.digest()
    report = result(studio.sandbox, studio.saved(folder, choose))
    assert report["state_sha256"] == found, (report, found)
