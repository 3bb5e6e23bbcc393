"""The server answers its own page on this machine, and nobody else; work that nobody waits for stops."""

from __future__ import annotations

import asyncio
import io
import json
import struct
import threading
import time

import aiohttp
import pytest

from vectorplot.animation.animation import Animation
from vectorplot.geometry.budget import in_turn
from vectorplot.pictures.film import animate
from vectorplot.viewer.answers import Answers
from vectorplot.viewer.pictures import Jobs, Source, SupersededError
from vectorplot.viewer.server import STATIC, Server, serving
from vectorplot.viewer.state import first_state

TEXT = "camera eye 5 -7 4\nDIE red box solid 1 2 1\n"


@pytest.fixture
def source(tmp_path):
    path = tmp_path / "die.scene"
    path.write_text(TEXT, encoding="utf-8")
    return Source(path)


def talk(source, conversation, film=None):
    """What a conversation with the server comes to."""

    async def all_of_it():
        server = Server(Answers(source, film))
        async with serving(server) as address, aiohttp.ClientSession() as session:
            return await conversation(server, address, session)

    return asyncio.run(all_of_it())


async def asked(session, address, what, **values):
    async with session.post(f"{address}ask/{what}", json={"page": "p", "text": None, **values}) as answer:
        return answer.status, answer.content_type, await answer.read()


def test_the_page_comes_with_strict_headers_and_nothing_from_elsewhere(source):
    async def conversation(server, address, session):
        assert address.startswith("http://127.0.0.1:") and server.token in address and len(server.token) >= 24
        found = {}
        for name in STATIC:
            async with session.get(address + name) as answer:
                assert answer.status == 200
                found[name] = await answer.text()
                policy = answer.headers["Content-Security-Policy"]
                assert "default-src 'none'" in policy and "unsafe" not in policy
                assert answer.headers["Cache-Control"] == "no-store"
        return found

    found = talk(source, conversation)
    for name, text in found.items():
        assert "https://" not in text
        assert "http://" not in text.replace("http://www.w3.org/2000/svg", ""), name
        assert " style=" not in text and "onclick" not in text


def test_strangers_are_turned_away(source):
    async def conversation(server, address, session):
        root = address.replace(server.token + "/", "")

        async def status(url, method="get", **more):
            async with session.request(method, url, **more) as answer:
                return answer.status

        return [
            await status(root),
            await status(root + "wrong-token/"),
            await status(address + "../etc/passwd"),
            await status(address + "ask/start"),
            await status(address, headers={"Host": "evil.example"}),
            await status(address + "ask/start", "post", json={}, headers={"Origin": "http://evil.example"}),
            await status(address + "ask/start", "post", data="{}", headers={"Content-Type": "text/plain"}),
            await status(address + "ask/start", "post", data="{", headers={"Content-Type": "application/json"}),
            await status(address + "ask/start", "post", json=[]),
            await status(address + "ask/nothing", "post", json={}),
            await status(address + "ask/by_name", "post", json={}),
            await status(
                address + "ask/start",
                "post",
                data=io.BytesIO(b" " * (3 << 20)),
                headers={"Content-Type": "application/json"},
            ),
            await status(address + "ask/start", "post", json={}, headers={"Origin": root.rstrip("/")}),
        ]

    assert talk(source, conversation) == [404, 404, 404, 405, 403, 403, 415, 400, 400, 404, 404, 413, 200]


def test_questions_have_answers(source):
    async def conversation(server, address, session):
        _, _, start = await asked(session, address, "start")
        _, _, scene = await asked(session, address, "scene")
        size = struct.unpack("<I", scene[:4])[0]
        head = json.loads(scene[4 : 4 + size])
        state = head["first"]
        _, _, keys = await asked(session, address, "keys", state=state, keys=["a", "w", "p"])
        fit = await asked(session, address, "fit", state={**state, "fov_deg": 3.0})
        pictures = [await asked(session, address, "picture", state=state)]
        pictures += [await asked(session, address, "save", state=state, format=word) for word in ("ps", "dxf", "pdf")]
        command = await asked(session, address, "command", state=state, format="svg")
        wrong = await asked(session, address, "save", state=state, format="exe")
        nothing = await asked(session, address, "picture", state={"azimuth": "north"})
        return start, head, scene[4 + size :], keys, fit, pictures, command, wrong, nothing

    start, head, lines, keys, fit, pictures, command, wrong, nothing = talk(source, conversation)
    assert json.loads(start)["text"] == TEXT
    assert (head["segments"], head["boxes"], len(lines)) == (12, 1, 13 * 24)
    assert json.loads(keys)["state"]["mode"] == "wire" and json.loads(keys)["wishes"] == ["ps"]
    assert json.loads(fit[2])["state"]["fov_deg"] > 10
    assert [kind for _, kind, _ in pictures] == [
        "image/svg+xml",
        "application/postscript",
        "image/vnd.dxf",
        "application/pdf",
    ]
    assert pictures[0][2].startswith(b"<?xml") and pictures[1][2].startswith(b"%!PS") and pictures[3][2][:4] == b"%PDF"
    assert json.loads(command[2])["line"].startswith("vectorplot draw ")
    assert wrong[0] == nothing[0] == 422


def test_errors_in_the_text_name_their_line_and_files_lie_beside_the_scene(source):
    async def conversation(server, address, session):
        bad = await asked(session, address, "scene", text="camera eye 5 -7 4\nDIE red box solid 1 two 1\n")
        (source.path.parent / "part.scene").write_text("BAR blue box solid 1 1 9", encoding="utf-8")
        good = await asked(session, address, "scene", text='include "part.scene"')
        out = await asked(session, address, "scene", text='include "/etc/passwd"')
        return bad, good, out

    bad, good, out = talk(source, conversation)
    assert bad[0] == 422 and json.loads(bad[2])["line"] == 2
    assert good[0] == 200, good[2]
    assert out[0] == 422


def test_the_stream_of_life_ends_with_the_server(source):
    async def conversation(server, address, session):
        async with session.get(address + "alive") as answer:
            assert b"here" in await answer.content.readany()
            async with session.post(address + "quit", json={}) as gone:
                assert gone.status == 200
            return await answer.content.read()

    assert b"event: end" in talk(source, conversation)


def test_the_latest_question_of_a_page_wins_and_pages_do_not_disturb_each_other():
    began, release, done = threading.Event(), threading.Event(), []

    def long(job):
        began.set()
        release.wait(30.0)
        job.progress("lines", 0.5)

    async def all_of_it():
        jobs = Jobs()
        first = asyncio.create_task(jobs.run("one", long))
        await asyncio.to_thread(began.wait)
        queued = asyncio.create_task(jobs.run("one", lambda job: done.append("queued")))
        other = asyncio.create_task(jobs.run("two", lambda job: "other"))
        await asyncio.sleep(0)
        last = asyncio.create_task(jobs.run("one", lambda job: "last"))
        await asyncio.sleep(0)
        release.set()
        results = await asyncio.gather(first, queued, other, last, return_exceptions=True)
        jobs.close()
        return results

    first, queued, other, last = asyncio.run(all_of_it())
    assert isinstance(first, SupersededError) and (other, last) == ("other", "last")
    assert done == [] and isinstance(queued, SupersededError)


def test_work_without_a_listener_stops_where_it_may_when_the_page_asks_for_something_newer():
    """Reading, fitting and writing have no progress."""
    began = threading.Event()

    def long(job):
        began.set()
        for _ in in_turn(range(3000)):
            time.sleep(0.01)
        return "done"

    async def all_of_it():
        jobs = Jobs()
        first = asyncio.create_task(jobs.run("one", long))
        await asyncio.to_thread(began.wait)
        last = await jobs.run("one", lambda job: "last")
        results = await asyncio.gather(first, return_exceptions=True)
        jobs.close()
        return last, *results

    last, first = asyncio.run(all_of_it())
    assert last == "last" and isinstance(first, SupersededError)


def test_the_end_stops_what_is_running():
    began = threading.Event()

    def long(job):
        began.set()
        job.stopped.wait(30.0)
        job.progress("lines", 0.5)

    async def all_of_it():
        jobs = Jobs()
        running = asyncio.create_task(jobs.run("one", long))
        await asyncio.to_thread(began.wait)
        jobs.close()
        with pytest.raises(SupersededError):
            await running

    asyncio.run(all_of_it())


WRONG = [
    None,
    True,
    -1,
    0,
    1.5,
    1e308,
    10**40,
    "",
    "x",
    "\x00",
    [],
    [1],
    [[]],
    [None] * 4,
    ["a", "b", "c"],
    {},
    {"a": [{}]},
]
"""Of every type that JSON has, alone and in each other."""


@pytest.mark.slow
def test_whatever_a_page_says_the_answer_is_none_of_a_broken_server(source, caplog):
    state = first_state(source.scene(None)).values()
    good = {
        "start": {},
        "scene": {},
        "keys": {"state": state, "keys": ["a"]},
        "fit": {"state": state},
        "picture": {"state": state},
        "frame": {"state": state, "frame": 1},
        "save": {"state": state, "format": "svg"},
        "command": {"state": state, "format": "svg"},
        "movie": {"frames": [state, {}], "fps": 10, "format": "svg"},
    }

    async def conversation(server, address, session):
        found = []

        async def say(what, values):
            found.append((what, values, *await asked(session, address, what, **values)))

        for what, values in good.items():
            await say(what, values)
            for name in ("page", "text", *values):
                for wrong in WRONG:
                    await say(what, {**values, name: wrong})
        for what in ("keys", "fit", "command"):
            for name in state:
                for wrong in WRONG:
                    await say(what, {**good[what], "state": {**state, name: wrong}})
        return found

    found = talk(source, conversation, lambda scene: animate(Animation(lambda _: scene, frames=3)))
    for what, values, status, kind, content in found:
        assert status in (200, 422), (what, values)
        if status == 422 or kind == "application/json":
            answer = json.loads(content, parse_constant=pytest.fail)
            assert status == 200 or "\n" not in answer["cause"]
    assert [status for what, values, status, _, _ in found if values is good[what]] == [200] * len(good)
    assert not caplog.records


def test_questions_while_the_server_ends_are_refused(source, caplog):
    async def conversation(server, address, session):
        server.stop.set()
        server.workers.close()
        return [(await asked(session, address, what))[0] for what in ("start", "picture", "movie", "save")]

    assert talk(source, conversation) == [409] * 4 and not caplog.records


def test_keys_do_not_wait_for_a_picture_that_takes_long(source, monkeypatch):
    began = threading.Event()

    def endless(self, asked, job):
        began.set()
        while True:
            job.progress("lines", 0.5)
            time.sleep(0.01)

    monkeypatch.setattr(Answers, "picture", endless)

    async def conversation(server, address, session):
        drawing = asyncio.create_task(asked(session, address, "picture"))
        await asyncio.to_thread(began.wait)
        state = first_state(source.scene(None)).values()
        pressed = await asyncio.wait_for(asked(session, address, "keys", state=state, keys=["v"]), 30.0)
        server.workers.close()
        return pressed, await drawing

    (status, _, content), drawn = talk(source, conversation)
    assert status == 200 and json.loads(content)["wishes"] == ["video"] and drawn[0] == 409


def test_questions_that_wait_when_the_server_ends_are_refused(source, caplog, monkeypatch):
    began = threading.Event()

    def long(self, asked, job):
        began.set()
        job.stopped.wait(30.0)
        job.progress("lines", 0.5)

    monkeypatch.setattr(Answers, "picture", long)
    monkeypatch.setattr(Answers, "movie", long)

    async def conversation(server, address, session):
        # Of each kind one that is worked on, and one that waits.
        asking = [asyncio.create_task(asked(session, address, what, page=page)) for page, what in QUESTIONS]
        await asyncio.to_thread(began.wait)
        while len(server.workers.pictures.latest) + len(server.workers.movies.latest) < len(QUESTIONS):
            await asyncio.sleep(0.01)
        server.workers.close()
        return [(status, content) for status, _, content in await asyncio.gather(*asking)]

    answers = talk(source, conversation)
    assert [status for status, _ in answers] == [409, 409, 200, 200]
    assert all(json.loads(content.splitlines()[-1]) == {"superseded": True} for _, content in answers[2:])
    assert not caplog.records


QUESTIONS = [("one", "picture"), ("two", "picture"), ("one", "movie"), ("two", "movie")]


def test_scenes_are_kept_and_files_read_anew_when_they_change(source):
    first = source.scene(None)
    assert source.scene(None) is first
    assert source.scene(TEXT) is source.scene(TEXT)
    for number in range(9):
        source.scene(f"DIE red box solid 1 1 {number + 1}")
    assert len(source._kept) <= 4


def test_meshes_have_no_text(tmp_path):
    path = tmp_path / "it.obj"
    path.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n", encoding="utf-8")
    assert Source(path).text() is None
    assert len(Source(path).scene(None).items) == 1


def test_frames_of_a_film_are_made_in_the_mode_of_the_page(source):
    scene = source.scene(None)

    def film(scene):
        return animate(Animation(lambda time: scene.items[0].turned("z", 90.0 * time), frames=3, mode="shading"))

    async def conversation(server, address, session):
        _, _, told = await asked(session, address, "start")
        state = first_state(scene).values()
        shown = zip((0, 2, 2, 3, True, "1"), ("lines", "lines", *4 * ["shading"]), strict=True)
        frames = [
            await asked(session, address, "frame", frame=number, state={**state, "mode": mode})
            for number, mode in shown
        ]
        return json.loads(told)["film"], frames

    told, frames = talk(source, conversation, film)
    assert told == {"frames": 3, "fps": 25.0, "mode": "shading"}
    assert [status for status, _, _ in frames] == [200, 200, 200, 422, 422, 422]
    assert len({pixels for _, _, pixels in frames[:3]}) == 3
    assert "3 frames" in json.loads(frames[3][2])["cause"]


def test_frames_are_those_of_the_edited_text(source):
    def film(scene):
        return animate(Animation(lambda time: scene.items[0].turned("z", 90.0 * time), frames=2, mode="shading"))

    async def conversation(server, address, session):
        state = first_state(source.scene(None)).values()
        texts = (None, TEXT.replace("red", "blue"), TEXT.replace("1 2 1", "1 two 1"), None)
        return [await asked(session, address, "frame", frame=1, state=state, text=text) for text in texts]

    frames = talk(source, conversation, film)
    assert [status for status, _, _ in frames] == [200, 200, 422, 200]
    assert frames[0] == frames[3] and json.loads(frames[2][2])["line"] == 2


def test_a_movie_comes_behind_lines_that_say_how_far_it_is(source):
    frames = [first_state(source.scene(None)).values(), {"azimuth": 0.2}]

    async def conversation(server, address, session):
        good = await asked(session, address, "movie", frames=frames, fps=25, format="svg")
        bad = await asked(session, address, "movie", frames=[], fps=25, format="svg")
        wrong = await session.post(f"{address}ask/movie", json=[])
        return good, bad, wrong.status, server.workers.movies.latest

    good, bad, wrong, latest = talk(source, conversation)
    *progress, head = [json.loads(line) for line in good[2].partition(b"<?xml")[0].splitlines()]
    assert head["name"] == "die.svg" and good[2][-head["bytes"] :].startswith(b"<?xml")
    assert progress and all(line["of"] in (1, 2) for line in progress)
    assert "recorded" in json.loads(bad[2].splitlines()[-1])["cause"]
    assert wrong == 400 and latest == {}
