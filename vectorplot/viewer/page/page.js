// The page of `vectorplot try`: asks its program over HTTP; its state is kept in the address, its text in the tab.
import { Refused, Superseded } from "./program.js";
import { viewer } from "./viewer.js";

const page = crypto.randomUUID();
let ended = () => {};

async function asked(what, values, signal) {
  const body = JSON.stringify({ page, ...values });
  return fetch(`ask/${what}`, { method: "POST", headers: { "Content-Type": "application/json" }, body, signal });
}
async function refusal(answer) {
  if (answer.status === 409) return new Superseded();
  if (answer.status === 422) return new Refused(await answer.json());
  return new Refused({ cause: answer.status === 413 ? "the scene is too long for the editor" : await answer.text() });
}
async function orEnded(work, signal) {
  try { return await work(); } catch (error) {
    if (error instanceof Refused || error instanceof Superseded) throw error;
    if (!signal?.aborted) ended();
    throw new Superseded();
  }
}
const ask = (what, values, signal) => orEnded(async () => {
  const answer = await asked(what, values, signal);
  if (!answer.ok) throw await refusal(answer);
  return await answer.blob();
}, signal);

// Lines of JSON say how far it is; the last one is followed by the movie.
const movie = (values, signal, progress) => orEnded(async () => {
  const answer = await asked("movie", values, signal);
  if (!answer.ok) throw await refusal(answer);
  const reader = answer.body.getReader();
  let bytes = new Uint8Array(0), head = null;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    const rest = new Uint8Array(bytes.length + value.length);
    rest.set(bytes);
    rest.set(value, bytes.length);
    bytes = rest;
    for (let end; !head?.name && (end = bytes.indexOf(10)) >= 0; bytes = bytes.slice(end + 1)) {
      head = JSON.parse(new TextDecoder().decode(bytes.slice(0, end)));
      if (head.cause) throw new Refused(head);
      if (head.superseded) throw new Superseded();
      if (!head.name) progress(head.done, head.of);
    }
  }
  if (!head?.name || bytes.length !== head.bytes) throw new Error("half an answer");
  return { name: head.name, blob: head.bytes ? new Blob([bytes], { type: head.kind }) : null };
}, signal);

const program = {
  ask,
  movie,
  keys: document,
  keep: (state) => history.replaceState(null, "", `#${encodeURIComponent(JSON.stringify(state))}`),
  kept() { try { return JSON.parse(decodeURIComponent(location.hash.slice(1))); } catch { return null; } },
  keepText(text) {
    try { if (text === null) sessionStorage.removeItem("text"); else sessionStorage.setItem("text", text); } catch { /* no room */ }
  },
  keptText() { try { return sessionStorage.getItem("text"); } catch { return null; } },
  titled: (name) => { document.title = `${name} – vectorplot`; },
  quit: () => fetch("quit", { method: "POST", headers: { "Content-Type": "application/json" }, body: "{}" }).catch(() => {}),
};
const shown = viewer(document.querySelector(".viewer"), program);
ended = shown.ended;
const alive = new EventSource("alive");
alive.addEventListener("end", () => { alive.close(); ended(); });
alive.onerror = () => { if (alive.readyState === EventSource.CLOSED) ended(); };
addEventListener("hashchange", () => shown.goTo(program.kept()));
