"""The local web server: on the loopback only, at a random port, behind a token in the address."""

from __future__ import annotations

import asyncio
import json
import secrets
import signal
from collections.abc import AsyncIterator, Awaitable, Callable, Mapping
from contextlib import asynccontextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from html import escape
from importlib.resources import files
from typing import Any

from aiohttp import web

from vectorplot.viewer.answers import ERRORS, Answers, json_bytes, told
from vectorplot.viewer.pictures import SupersededError, Workers
from vectorplot.viewer.sketches import Sketch

HOST = "127.0.0.1"

MOST_BYTES = 2 << 20
"""The largest request."""

SCRIPTS = ("page.js", "viewer.js", "recorder.js", "recording.js", "canvases.js", "projection.js", "program.js")
"""What the page runs, from its address inwards."""

STATIC = {"": ("index.html", "text/html"), "viewer.css": ("viewer.css", "text/css")} | {
    "icon.svg": ("icon.svg", "image/svg+xml"),
    **{name: (name, "text/javascript") for name in SCRIPTS},
}
"""The files of the page and their media types, by the ends of their addresses."""

FILM_FILES = {"viewer.css": "text/css", "icon.svg": "image/svg+xml", "film.js": "text/javascript"}
"""The files of the page that shows a film, but for itself and the film, and their media types."""

SKETCH_FILES = {"viewer.css": "text/css", "icon.svg": "image/svg+xml", "sketch.js": "text/javascript"}
"""The same of the page of a sketch."""

HEADERS = {
    "Content-Security-Policy": (
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' blob:; connect-src 'self'; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    ),
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cache-Control": "no-store",
}
"""What every answer says: nothing from elsewhere, nothing kept."""

TOLD_S = 0.2
"""So often the page is told how many frames of a movie are drawn."""

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]


@dataclass(eq=False)
class Server:
    """The page, what it asks for, and when it ends; pages: files by the ends of their addresses, each with its media
    type; without answers the page asks for nothing."""

    answers: Answers | Sketch | None
    pages: Mapping[str, tuple[bytes, str]] = field(default_factory=lambda: viewer_pages())
    token: str = field(default_factory=lambda: secrets.token_urlsafe(18))
    workers: Workers = field(default_factory=Workers)
    stop: asyncio.Event = field(default_factory=asyncio.Event)

    def app(self) -> web.Application:
        """What answers requests."""

        @web.middleware
        async def guarded(request: web.Request, handler: Handler) -> web.StreamResponse:
            return await self._guarded(request, handler)

        app = web.Application(client_max_size=MOST_BYTES, middlewares=[guarded])
        base = f"/{self.token}"
        for name in self.pages:
            app.router.add_get(f"{base}/{name}", self._file)
        app.router.add_get(f"{base}/alive", self._alive)
        app.router.add_post(f"{base}/quit", self._quit)
        if isinstance(self.answers, Answers):
            app.router.add_post(f"{base}/ask/movie", partial(self._movie, self.answers))
        if self.answers is not None:
            app.router.add_post(f"{base}/ask/{{what}}", partial(self._ask, self.answers))
        return app

    async def _guarded(self, request: web.Request, handler: Handler) -> web.StreamResponse:
        """Requests that name this server as their host, and come from its own page or from no page."""
        own = {f"{name}:{request.transport.get_extra_info('sockname')[1]}" for name in (HOST, "localhost")}  # type: ignore[union-attr]  # there is one while it is answered
        origin = request.headers.get("Origin")
        if request.headers.get("Host") not in own or (origin is not None and origin.removeprefix("http://") not in own):
            response: web.StreamResponse = web.Response(status=403, text="this page is for this machine only")
        elif request.method == "POST" and request.content_type != "application/json":
            response = web.Response(status=415, text="expected JSON")
        else:
            try:
                response = await handler(request)
            except web.HTTPException as refused:
                response = web.Response(status=refused.status, text=refused.reason)
        if not response.prepared:
            response.headers.update(HEADERS)
        return response

    async def _file(self, request: web.Request) -> web.Response:
        content, kind = self.pages[request.path.rpartition("/")[2]]
        return web.Response(body=content, content_type=kind, charset="utf-8")

    async def _alive(self, request: web.Request) -> web.StreamResponse:
        """A stream of events that lasts as long as the server."""
        response = web.StreamResponse(headers={**HEADERS, "Content-Type": "text/event-stream"})
        await response.prepare(request)
        await response.write(b"retry: 1000\n\ndata: here\n\n")
        await self.stop.wait()
        # A page that was closed before hears nothing of the end.
        with suppress(ConnectionError):
            await response.write(b"event: end\ndata: end\n\n")
        return response

    async def _quit(self, request: web.Request) -> web.Response:
        self.stop.set()
        return web.json_response({})

    async def _ask(self, answers: Answers | Sketch, request: web.Request) -> web.Response:
        what = request.match_info["what"]
        answer = answers.by_name(what)
        if answer is None:
            return web.Response(status=404, text="no such question")
        asked = await _asked(request)
        try:
            made = await self.workers.of(what).run(f"{_page(asked)} {what}", lambda job: answer(asked, job))
        except SupersededError:
            return web.Response(status=409, text="superseded")
        except ERRORS as error:
            return web.json_response(told(error), status=422)
        if isinstance(made, tuple):
            content, kind = made
            return web.Response(body=content, content_type=kind)
        return web.json_response(made)

    async def _movie(self, answers: Answers, request: web.Request) -> web.StreamResponse:
        """Lines of JSON, how many frames are drawn, and behind the last one the movie. It stops where the page goes."""
        asked = await _asked(request)
        response = web.StreamResponse(headers={**HEADERS, "Content-Type": "application/octet-stream"})
        try:
            job, made = self.workers.movies.submit(_page(asked), lambda job: answers.movie(asked, job))
        except SupersededError:
            return web.Response(status=409, text="superseded")
        waiting = asyncio.wrap_future(made)
        try:
            await response.prepare(request)
            while not waiting.done():
                await asyncio.wait([waiting], timeout=TOLD_S)
                done, of = job.frames
                await response.write(_line({"done": done, "of": of or 1}))
            if waiting.cancelled():
                raise SupersededError("the program ends")
            name, content, kind = waiting.result()
            await response.write(_line({"name": name, "kind": kind, "bytes": len(content)}) + content)
        except SupersededError:
            await response.write(_line({"superseded": True}))
        except ConnectionError:
            pass
        except ERRORS as error:
            await response.write(_line(told(error)))
        finally:
            self.workers.movies.end(job)
        return response


async def _asked(request: web.Request) -> Mapping[str, Any]:
    """What the page tells. Errors: HTTPBadRequest for what is no mapping."""
    try:
        asked = json.loads(await request.text(), parse_int=_whole_number)
        # Halves of surrogate pairs are JSON, but no text.
        json.dumps(asked, ensure_ascii=False).encode()
    except (ValueError, OverflowError, RecursionError):
        raise web.HTTPBadRequest(reason="not JSON") from None
    if not isinstance(asked, Mapping):
        raise web.HTTPBadRequest(reason="expected a mapping")
    return asked


def _whole_number(digits: str) -> int:
    """The number. Errors: OverflowError, ValueError for one that is no double."""
    number = int(digits)
    float(number)
    return number


def _page(asked: Mapping[str, Any]) -> str:
    """The name of the page that asks."""
    return str(asked.get("page"))[:64]


def _line(values: Mapping[str, Any]) -> bytes:
    return json_bytes(values) + b"\n"


@asynccontextmanager
async def serving(server: Server) -> AsyncIterator[str]:
    """The address of the page, while it is served; after that all work has stopped."""
    runner = web.AppRunner(server.app(), access_log=None, handle_signals=False, shutdown_timeout=1.0)
    await runner.setup()
    try:
        site = web.TCPSite(runner, HOST, 0)
        await site.start()
        yield f"http://{HOST}:{runner.addresses[0][1]}/{server.token}/"
    finally:
        server.stop.set()
        server.workers.close()
        await runner.cleanup()


async def serve(answers: Answers, started: Callable[[str], None], timeout_s: float | None) -> None:
    """Serve the viewer until it is told to quit, a signal comes or the time is over; started is told the address."""
    await _served(Server(answers), started, timeout_s)


async def serve_film(
    svg: bytes, title: str, frames: int, fps: float, started: Callable[[str], None], timeout_s: float | None
) -> None:
    """Serve a page that shows a film, an SVG of so many frames that moves by itself, as serve does."""
    page = _page_file("film.html").decode().format(title=escape(title, quote=True), frames=frames, fps=fps)
    pages = {"": (page.encode(), "text/html"), "film.svg": (svg, "image/svg+xml")}
    pages |= {name: (_page_file(name), kind) for name, kind in FILM_FILES.items()}
    await _served(Server(None, pages), started, timeout_s)


async def serve_sketch(sketch: Sketch, started: Callable[[str], None], timeout_s: float | None) -> None:
    """Serve a page that shows what a sketch draws, and sliders for its parameters, as serve does."""
    await _served(Server(sketch, sketch_pages(sketch)), started, timeout_s)


def sketch_pages(sketch: Sketch) -> dict[str, tuple[bytes, str]]:
    """The files of the page of a sketch."""
    page = _page_file("sketch.html").decode().format(title=escape(sketch.path.name, quote=True))
    return {"": (page.encode(), "text/html")} | {name: (_page_file(name), kind) for name, kind in SKETCH_FILES.items()}


def viewer_pages() -> dict[str, tuple[bytes, str]]:
    """The files of the viewer."""
    return {end: (_page_file(name), kind) for end, (name, kind) in STATIC.items()}


def _page_file(name: str) -> bytes:
    return files("vectorplot.viewer").joinpath("page", name).read_bytes()


async def _served(server: Server, started: Callable[[str], None], timeout_s: float | None) -> None:
    loop = asyncio.get_running_loop()
    for name in ("SIGINT", "SIGTERM", "SIGHUP"):
        number = getattr(signal, name, None)
        if number is None:
            continue
        try:
            loop.add_signal_handler(number, server.stop.set)
        except NotImplementedError:
            # Windows has no such handlers; the usual ones run in the main thread, as the loop does.
            signal.signal(number, lambda *_: loop.call_soon_threadsafe(server.stop.set))
    async with serving(server) as address:
        started(address)
        try:
            await asyncio.wait_for(server.stop.wait(), timeout_s)
        except TimeoutError:
            pass
