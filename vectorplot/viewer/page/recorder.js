// Recording what is seen: v or the button begins and ends it; then the program draws every frame exactly, as one movie.
import { Refused, Superseded } from "./program.js";
import { FRAME_MS, Recording } from "./recording.js";

const NAMES = { mp4: "MP4 video", svg: "SVG that moves", pdf: "PDF, a page a frame", vd1: "Polygons (.vd1, .vd2)" };

// shared: state() is what is seen now; make(values, signal, progress) has a movie made; say(words); save(blob, name).
export function recorder(root, shared) {
  const at = (id) => root.querySelector(`#${id}`);
  let recording = null, making = null;

  function show() {
    at("record").setAttribute("aria-pressed", recording !== null);
    at("record").disabled = making !== null;
    at("recording").hidden = recording === null;
    at("making").hidden = making === null;
    at("play").disabled = recording !== null;
    if (recording) at("recording").textContent = `Recording: ${recording.states.length} frames`;
  }

  function seen(state) {
    if (!recording) return;
    recording.see(state, performance.now());
    show();
    if (recording.full) finish();
  }

  function pressed() {
    if (making) shared.say("The movie before is still being drawn");
    else if (recording) finish();
    else {
      recording = new Recording(shared.state());
      at("movie-told").textContent = "";
      show();
    }
  }

  async function finish() {
    const { frames, full } = { frames: recording.frames(), full: recording.full };
    recording = null;
    making = new AbortController();
    const mine = making, words = full ? "That is as long as recordings get. " : "";
    const tell = (done, of) => {
      at("progress").value = done / of;
      shared.say(`${words}Drawing frame ${Math.min(done + 1, of)} of ${of}`);
    };
    show();
    tell(0, frames.length);
    let last = "";
    try {
      const made = await shared.make({ frames, fps: 1000 / FRAME_MS, format: at("movie-format").value || null }, mine.signal, tell);
      if (made.blob) shared.save(made.blob, made.name);
      last = `Saved ${made.name}: ${frames.length} frames`;
    } catch (error) {
      if (error instanceof Refused) last = error.message;
      else if (error instanceof Superseded) last = "Nothing was saved";
      else throw error;
    } finally {
      making = null;
      show();
    }
    at("movie-told").textContent = last;
    shared.say(last);
  }

  // What movies may be: formats to choose from, or the file that they are always written to.
  function offers({ formats, file }) {
    at("movie-format").replaceChildren(...formats.map((word) => new Option(NAMES[word] ?? word, word)));
    at("movie-format").hidden = file !== null;
    if (file !== null) at("movie-told").textContent = `Goes to ${file}`;
  }

  at("record").addEventListener("click", pressed);
  at("stop-movie").addEventListener("click", () => making?.abort());
  return { seen, pressed, offers, removed: () => making?.abort() };
}
