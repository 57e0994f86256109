# Copyright (c) the meshorder authors. SPDX-License-Identifier: MIT
"""Debian's headless Chromium, and the operations that tests need."""
import base64
import io
import json
import shutil

import numpy
import pytest

FLAGS = ["--headless=new", "--no-sandbox", "--disable-gpu", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
         "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update",
         "--disable-sync", "--disable-default-apps", "--disable-dev-shm-usage",
         "--hide-scrollbars", "--force-device-scale-factor=1"]


def open_chromium(profile):
    """A fresh Chromium with its profile in the given folder; skips the test where there is none."""
    if not shutil.which("chromium") or not shutil.which("chromedriver"):
        pytest.skip("needs chromium and chromedriver")
    webdriver = pytest.importorskip("selenium.webdriver")
    from selenium.webdriver.chrome.service import Service
    options = webdriver.ChromeOptions()
    options.binary_location = shutil.which("chromium")
    for flag in [*FLAGS, f"--user-data-dir={profile}"]:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(service=Service(shutil.which("chromedriver")), options=options)
    driver.set_script_timeout(90)
    return driver


class Browser:
    """A page in Chromium."""

    def __init__(self, driver):
        self.driver = driver

    def resize(self, width, height, phone=False):
        """Sets the width and height of the page itself, without a window's frame."""
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": 2 if phone else 1, "mobile": phone})

    def dark(self, on):
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "features": [{"name": "prefers-color-scheme", "value": "dark" if on else "light"}]})

    def media(self, name):
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {"media": name})

    def open(self, path, tab=""):
        """Loads the page afresh, and waits until it is complete."""
        self.driver.get("about:blank")
        self.driver.get(path.resolve().as_uri() + (f"#{tab}" if tab else ""))

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def wait(self, condition, *arguments, seconds=60):
        """Waits until a JavaScript expression is true, and returns it."""
        # the expression is a part of the script: pages do not allow strings to be evaluated
        done = self.driver.execute_async_script(f"""
            const [seconds, parameters, done] = arguments;
            const until = performance.now() + seconds * 1000;
            const look = () => {{
              const found = {condition};
              if (found || performance.now() > until) done(found); else setTimeout(look, 40);
            }};
            look();""", seconds, arguments)
        assert done, f"never came true: {condition}"
        return done

    def tab(self, name):
        """Clicks on a tab, and waits until its canvases are drawn."""
        self.run("document.getElementById('tab-' + arguments[0]).click()", name)
        if name in ("meshes", "motion", "spans"):
            self.wait("[...document.querySelectorAll('#' + parameters[0] + ' canvas')].some((one) => one.width !== 300)", name)
            self.settle()

    def settle(self):
        """Waits for two animation frames; pending changes are drawn then."""
        self.driver.execute_async_script(
            "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 0)));")

    def pixels(self, canvas):
        """A canvas's picture as height × width × 4 numbers."""
        self.settle()
        width, height, text = self.run("""
            const canvas = typeof arguments[0] === "string" ? document.querySelector(arguments[0]) : arguments[0];
            const copy = document.createElement("canvas");
            Object.assign(copy, {width: canvas.width, height: canvas.height});
            const context = copy.getContext("2d", {willReadFrequently: true});
            context.drawImage(canvas, 0, 0);
            const data = context.getImageData(0, 0, canvas.width, canvas.height).data;
            let text = "";
            for (let i = 0; i < data.length; i += 8192) text += String.fromCharCode(...data.subarray(i, i + 8192));
            return [canvas.width, canvas.height, btoa(text)];""", canvas)
        return numpy.frombuffer(base64.b64decode(text), dtype=numpy.uint8).reshape(height, width, 4)

    def picture(self, path, whole=False):
        """Writes a PNG of the visible part, or of the whole page."""
        self.settle()
        shot = self.driver.execute_cdp_cmd("Page.captureScreenshot", {"format": "png", "captureBeyondViewport": whole})
        path.write_bytes(base64.b64decode(shot["data"]))

    def pdf(self):
        printed = self.driver.execute_cdp_cmd("Page.printToPDF", {"printBackground": True})
        return base64.b64decode(printed["data"])

    def complaints(self):
        """The console's messages since the last call."""
        # the browser warns that reading pixels is slow; the tests have to read them
        return [entry["message"] for entry in self.driver.get_log("browser") if "GPU stall" not in entry["message"]]

    def requests(self):
        """Addresses requested since the last call, without data in the page and without the browser's own pages."""
        messages = [json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")]
        asked = [message["params"]["request"]["url"] for message in messages
                 if message["method"] == "Network.requestWillBeSent"]
        return [url for url in asked if not url.startswith(("data:", "blob:", "about:", "chrome:", "chrome-untrusted:"))]
