"""A headless Chromium driven over its DevTools pipe: no more is needed than the browser itself."""

import fcntl
import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any, NamedTuple

import pytest

CHROMIUM = next(
    (found for name in ("chromium", "chromium-browser", "google-chrome", "chrome") if (found := shutil.which(name))),
    None,
)


def live(test):
    """A test that needs a browser."""
    return pytest.mark.browser(pytest.mark.skipif(CHROMIUM is None, reason="no Chromium is installed")(test))


class View(NamedTuple):
    """How a page is shown; one that is `still` moves only if it is asked to."""

    width: int = 1280
    height: int = 900
    dark: bool = False
    still: bool = True


class Browser:
    """One page. Messages that the page writes to its console, and errors in it, are kept in `complaints`."""

    def __init__(self, profile: Path) -> None:
        ours_in, theirs_out = os.pipe()
        theirs_in, ours_out = os.pipe()
        theirs = [fcntl.fcntl(end, fcntl.F_DUPFD, 20) for end in (theirs_in, theirs_out)]  # they become 3 and 4
        os.close(theirs_in)
        os.close(theirs_out)
        options = (
            *("--headless", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe", "--no-first-run"),
            *("--disable-dev-shm-usage", "--force-color-profile=srgb", f"--user-data-dir={profile}"),
            *("--disable-extensions", "--disable-background-networking", "--disable-component-update"),
            "--disable-features=SpareRendererForSitePerProcess,BackForwardCache",
        )
        self._process = subprocess.Popen(
            [str(CHROMIUM), *options],
            close_fds=False,
            preexec_fn=lambda: (os.dup2(theirs[0], 3), os.dup2(theirs[1], 4)),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        for end in theirs:
            os.close(end)
        self._in = os.fdopen(ours_in, "rb")
        self._out = os.fdopen(ours_out, "wb")
        self._unread = b""
        self._count = 0
        self._session = ""
        self._loaded = 0  # pages so far
        self.complaints: list[str] = []
        self.requests: list[str] = []
        self._shown: tuple[Path, View] | None = None
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **params: Any) -> Any:
        """Result of a DevTools command."""
        self._count += 1
        session = {"sessionId": self._session} if self._session else {}
        message = {"id": self._count, "method": method, "params": params} | session
        self._out.write(json.dumps(message).encode() + b"\0")
        self._out.flush()
        while (answer := self._next()).get("id") != self._count:
            pass
        if "error" in answer:
            raise RuntimeError(f"{method}: {answer['error']}")
        return answer["result"]

    def open(self, page: Path, address: str = "", **how: Any) -> None:
        """Show a file and wait until it is loaded; `how`: attributes of `View`."""
        view = View(**how)
        size = {"width": view.width, "height": view.height}
        self.call("Emulation.setDeviceMetricsOverride", **size, deviceScaleFactor=1, mobile=False)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if view.dark else "light"}
        motion = {"name": "prefers-reduced-motion", "value": "reduce" if view.still else "no-preference"}
        self.call("Emulation.setEmulatedMedia", features=[scheme, motion])
        self.complaints = []
        self.requests = []
        self._shown = page, view
        loaded = self._loaded
        url = f"{page.as_uri()}?{self._count}{address}"  # another address alone loads no page
        self.call("Page.navigate", url=url)  # the page may be loaded before this is answered
        while self._loaded == loaded:
            self._next()

    def keep(self, page: Path, address: str = "", **how: Any) -> bool:
        """Show a file at an address, but leave it as it is, with its address, if it is shown already; return whether it
        was. Loading a page takes longer than most of what tests do with it.
        """
        kept = self._shown == (page, View(**how))
        if not kept:
            self.open(page, address, **how)
        self.complaints = []
        return kept

    def run(self, script: str) -> Any:
        """Value of an expression in the page (a promise is awaited)."""
        answer = self.call("Runtime.evaluate", expression=script, returnByValue=True, awaitPromise=True)
        if "exceptionDetails" in answer:
            raise RuntimeError(str(answer["exceptionDetails"]))
        return answer["result"].get("value")

    def wait_for(self, condition: str, most: float = 5) -> None:
        """Wait until an expression in the page is true; whoever waits so looks at the page himself afterwards.

        Args:
            condition: the expression.
            most: seconds after which nothing more is waited for.
        """
        look = f"const look = () => ({condition}) || performance.now() > end ? done() : setTimeout(look, 5)"
        self.run(f"new Promise(done => {{ const end = performance.now() + {1000 * most}; {look}; look(); }})")

    def read(self, name: str) -> str:
        """Text of the element with this id."""
        return str(self.run(f"document.getElementById('{name}').textContent"))

    def press(self, key: str, code: int, text: str = "") -> None:
        """One key, as from a keyboard."""
        for kind in ("keyDown", "keyUp"):
            written = {"text": text} if text and kind == "keyDown" else {}
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=key, windowsVirtualKeyCode=code, **written)

    def close(self) -> None:
        self._session = ""
        try:
            self.call("Browser.close")
        except (OSError, EOFError):
            self._process.terminate()
        self._process.wait(300)
        self._in.close()
        self._out.close()

    def _next(self) -> dict[str, Any]:
        """The next message, noted if it is a complaint or a request."""
        while b"\0" not in self._unread:
            more = os.read(self._in.fileno(), 1 << 20)
            if not more:
                raise EOFError("the browser has gone")
            self._unread += more
        data, _, self._unread = self._unread.partition(b"\0")
        message: dict[str, Any] = json.loads(data)
        params = message.get("params", {})
        match message.get("method"):
            case "Page.loadEventFired":
                self._loaded += 1
            case "Runtime.consoleAPICalled":
                self.complaints.append(str([arg.get("value") for arg in params["args"]]))
            case "Runtime.exceptionThrown":
                self.complaints.append(str(params["exceptionDetails"]))
            case "Log.entryAdded":
                self.complaints.append(params["entry"]["text"])
            case "Network.requestWillBeSent":
                self.requests.append(params["request"]["url"])
            case "Page.javascriptDialogOpening":
                self.complaints.append(f"dialog: {params['message']}")
                self.call("Page.handleJavaScriptDialog", accept=True)
        return message
