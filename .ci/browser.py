"""A real browser for pages: a headless Chromium, which logs messages and requests."""

import base64
import json
import shutil
from pathlib import Path

from selenium import webdriver

FLAGS = """--headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking
--disable-component-update --disable-sync --hide-scrollbars --force-color-profile=srgb"""


def browser(folder: Path, is_offline: bool) -> webdriver.Chrome:
    """A browser, with or without a network, whose profile and downloads are in `folder`."""
    options = webdriver.ChromeOptions()
    for flag in FLAGS.split():
        options.add_argument(flag)
    options.add_argument(f"--user-data-dir={folder}/profile")
    options.add_experimental_option("prefs", {"download.default_directory": str(folder)})
    names = ["chromium", "chromium-browser", "google-chrome"]
    options.binary_location = next(filter(None, map(shutil.which, names)))
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    service = webdriver.ChromeService(executable_path=shutil.which("chromedriver"))
    driver = webdriver.Chrome(options=options, service=service)
    driver.execute_cdp_cmd("Network.enable", {})
    if is_offline:
        offline = {"offline": True, "latency": 0, "downloadThroughput": 0, "uploadThroughput": 0}
        driver.execute_cdp_cmd("Network.emulateNetworkConditions", offline)
    return driver


def resize(driver: webdriver.Chrome, width: int, height: int) -> None:
    """Sets the size of the window's content, as that of a phone if it is narrow."""
    metrics = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 500}
    driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)


def picture(driver: webdriver.Chrome, file: Path) -> None:
    """Writes what the window shows."""
    shot = driver.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": False})
    file.write_bytes(base64.b64decode(shot["data"]))


def messages(driver: webdriver.Chrome) -> list[dict]:
    """The warnings and errors since the last call."""
    return [entry for entry in driver.get_log("browser") if entry["level"] != "INFO"]


def requested(driver: webdriver.Chrome) -> set[str]:
    """The addresses that were asked for since the last call."""
    sent = [json.loads(entry["message"])["message"] for entry in driver.get_log("performance")]
    sent = [entry["params"] for entry in sent if entry["method"] == "Network.requestWillBeSent"]
    return {entry["request"]["url"].partition("#")[0] for entry in sent}
