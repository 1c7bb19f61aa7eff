# Headless Chromium, driven through its DevTools protocol over a pipe: no driver program, no port.
import base64
import fcntl
import itertools
import json
import os
import select
import subprocess
import time

PROGRAM = "/usr/bin/chromium"
# Nothing may reach a network: every name is unknown.
FLAGS = ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage",
         "--mute-audio", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--host-resolver-rules=MAP * ~NOTFOUND",
         "--remote-debugging-pipe", "about:blank")
# What is taller than two screens on a page whose details are open.
TALL = """(() => { document.querySelectorAll('details').forEach(one => one.open = true);
  return [...document.querySelectorAll('figure, table')].filter(one => one.getBoundingClientRect().height > 2 * innerHeight)
    .map(one => one.outerHTML.slice(0, 120)); })()"""
# Elements that hide something of their width.
HIDDEN = """[...document.querySelectorAll('main *')].filter(one => one.scrollWidth > one.clientWidth + 1 &&
  getComputedStyle(one).overflowX !== 'visible' && one.checkVisibility()).map(one => one.outerHTML.slice(0, 120))"""
COMPLAINTS = ("Runtime.exceptionThrown", "Log.entryAdded", "Runtime.consoleAPICalled")


class Navigated(AssertionError):
    """The page was left while it was asked."""


class Browser:
    """One page. `complaints` has everything that it wrote to the console, `requests` every address
    that it asked for; both grow while commands run."""

    def __init__(self, profile, width=1200, height=760):
        commands, self._send = os.pipe()
        self._receive, answers = os.pipe()
        # The browser wants these two at 3 and 4; above 9 neither is in the other's place.
        high = [fcntl.fcntl(end, fcntl.F_DUPFD, 10) for end in (commands, answers)]
        shell = f'exec "$@" 3<&{high[0]} 4>&{high[1]}'
        self._process = subprocess.Popen(
            ["/bin/bash", "-c", shell, "bash", PROGRAM, f"--user-data-dir={profile}", *FLAGS],
            pass_fds=high, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL, env=os.environ | {"HOME": str(profile)})
        for end in (commands, answers, *high):
            os.close(end)
        self._number, self._buffer, self._session = itertools.count(1), b"", None
        self.complaints, self.requests = [], []
        targets = self.call("Target.getTargets")["targetInfos"]
        page = next(target["targetId"] for target in targets if target["type"] == "page")
        self._session = self.call("Target.attachToTarget", targetId=page, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        self.resize(width, height)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._session = None
        try:
            self.call("Browser.close", seconds=5)
        except (OSError, AssertionError):
            self._process.kill()
        self._process.wait()
        os.close(self._send)
        os.close(self._receive)

    def call(self, method, seconds=60, **parameters):
        """Sends one command and returns its result."""
        number = next(self._number)
        message = {"id": number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._send, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + seconds
        while True:
            answer = self._next(end)
            if answer.get("id") == number:
                if "navigated" in answer.get("error", {}).get("message", ""):
                    raise Navigated(f"{method}: {answer['error']}")
                assert "error" not in answer, f"{method}: {answer['error']}"
                return answer["result"]
            self._note(answer)

    def _next(self, end):
        while b"\0" not in self._buffer:
            left = end - time.monotonic()
            assert left > 0 and select.select([self._receive], [], [], left)[0], "browser is silent"
            part = os.read(self._receive, 1 << 20)
            assert part, "browser has ended"
            self._buffer += part
        text, _, self._buffer = self._buffer.partition(b"\0")
        return json.loads(text)

    def _note(self, event):
        if event.get("method") in COMPLAINTS:
            self.complaints.append(event["params"])
        elif event.get("method") == "Network.requestWillBeSent":
            self.requests.append(event["params"]["request"]["url"])

    def resize(self, width, height, scale=1, mobile=False):
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height,
                  deviceScaleFactor=scale, mobile=mobile)

    def prefer(self, **features):
        """Media features, such as prefers_color_scheme="dark"."""
        self.call("Emulation.setEmulatedMedia", features=[
            {"name": name.replace("_", "-"), "value": value} for name, value in features.items()])

    def open(self, path):
        self.call("Page.navigate", url=path.resolve().as_uri())
        self.wait("document.readyState === 'complete' && location.protocol === 'file:'")

    def value(self, expression):
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True,
                           awaitPromise=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def wait(self, expression, seconds=30):
        end = time.monotonic() + seconds
        while not self._holds(expression):
            assert time.monotonic() < end, f"never came true: {expression}"
            time.sleep(0.05)

    def _holds(self, expression):
        try:
            return self.value(expression)
        except Navigated:
            return False

    def key(self, key, **more):
        text = {"text": key} if len(key) == 1 else {}
        self.call("Input.dispatchKeyEvent", type="keyDown", key=key, **text, **more)
        self.call("Input.dispatchKeyEvent", type="keyUp", key=key, **more)

    def mouse(self, *steps):
        """Steps (kind, x, y), with kind such as mousePressed, as the protocol calls them."""
        for kind, x, y in steps:
            more = {"deltaX": 0, "deltaY": -240} if kind == "mouseWheel" else {}
            self.call("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1,
                      clickCount=1, **more)

    def screenshot(self, path):
        answer = self.call("Page.captureScreenshot", format="png")
        path.write_bytes(base64.b64decode(answer["data"]))
