// The viewer itself, in whatever page: it keeps state and text; the program answers questions and forgets.
import { clear, paintMoving, paintOver, sized } from "./canvases.js";
import { Refused, Superseded } from "./program.js";
import { axesOf, boxLines, pictureHeight } from "./projection.js";
import { recorder } from "./recorder.js";

const STILL_MS = 140, TYPED_MS = 250;

// root: the element with all that index.html has in its body. program: how it is asked, and where things are kept.
// Given back: what tells it that the program has ended, that it is looked at from elsewhere, and that it is not shown any more.
export function viewer(root, program) {
  const at = (id) => root.querySelector(`#${id}`);
  const stage = at("stage"), exact = at("exact");
  let state = null, scene = null, text = null, fileText = null, name = "scene", frames = 0, drawn = false, gone = false;

  const ask = (what, more = {}, signal = undefined) => program.ask(what, { state, text, ...more }, signal);
  const asJson = async (answer) => JSON.parse(await (await answer).text());
  const told = (error) => { if (error instanceof Refused) say(error.message); else if (!(error instanceof Superseded)) throw error; };
  const say = (words) => { at("status").textContent = words; };
  function ended() { gone = true; at("gone").hidden = false; stage.classList.remove("works"); say("The program has stopped."); }

  // --- state ----------------------------------------------------------------------------------------------------------
  function change(values) { become({ ...state, ...values }); }
  // What an answer changed in the state that was asked about; what has changed since then stays.
  function answered(about, answer) {
    const differs = ([field, value]) => JSON.stringify(value) !== JSON.stringify(about[field]);
    change(Object.fromEntries(Object.entries(answer).filter(differs)));
  }
  const OVER = ["axes", "boxes", "lights", "colour_map", "former", "rotating", "wish"];
  const looks = (one) => JSON.stringify({ ...one, ...Object.fromEntries(OVER.map((field) => [field, null])) });
  function become(next) {
    const same = state && looks(state) === looks(next) && state.rotating === next.rotating;
    state = next;
    program.keep(state);
    show();
    if (same) over();
    else {
      recording.seen(state);
      move();
    }
  }

  const CHECKS = { outlines: "outlines", axes: "axes", boxes: "boxes", lights: "lights", "colour-map": "colour_map", "depth-buffer": "depth_buffer", parallel: "parallel", landscape: "landscape" };
  const degrees = (radians) => Math.round((radians * 180) / Math.PI);
  const around = (angle) => degrees(Math.atan2(Math.sin(angle), Math.cos(angle)));
  const number = (value) => Number(value.toPrecision(4)).toString();

  function show() {
    for (const radio of root.querySelectorAll("[name=mode]")) radio.checked = radio.value === state.mode;
    for (const [id, field] of Object.entries(CHECKS)) at(id).checked = state[field];
    at("along").checked = state.lights_go_along_from !== null;
    const sliders = { crease: [state.crease_angle_deg, "°"], spacing: [state.spacing_mm, " mm"], "light-azimuth": [around(state.light_azimuth), "°"], "light-elevation": [around(state.light_elevation), "°"] };
    for (const [id, [value, unit]] of Object.entries(sliders)) {
      at(id).value = value;
      root.querySelector(`output[for=${id}]`).textContent = `${Number(value.toFixed(1))}${unit}`;
    }
    at("hatch").value = state.hatch;
    for (const id of ["hatch", "spacing"]) at(id).disabled = state.mode !== "lines" || (id === "spacing" && state.hatch === "none");
    at("crease").disabled = state.mode === "wire";
    at("outlines").disabled = state.mode === "wire" || state.mode === "erasing";
    at("depth-buffer").disabled = !["shading", "shadows"].includes(state.mode);
    at("former").disabled = state.former === null;
    at("rotate").setAttribute("aria-pressed", state.rotating);
    at("where").textContent = `azimuth ${around(state.azimuth)}°  elevation ${around(state.elevation)}°  twist ${around(state.twist)}°  distance ${number(state.distance)}  ` + (state.parallel ? `height ${number(pictureHeight(state))}` : `field ${number(state.fov_deg)}°`);
    stage.classList.toggle("night", state.mode === "wire");
    at("colours").hidden = !state.colour_map;
    if (scene) sized(root, state, scene);
  }

  // --- what moves -----------------------------------------------------------------------------------------------------
  function painting() {
    drawn = false;
    if (!scene) return;
    if (stage.classList.contains("moves")) {
      paintMoving(at("moving"), state, scene);
      stage.dataset.frames = ++frames;
      stage.dataset.lines = scene.segments;
    }
    over();
  }
  const over = () => { if (scene) paintOver(at("over"), state, scene); };
  let waiting = 0, job = null, from = 0;
  function move() {
    playing = false;
    stage.classList.add("moves");
    stage.dataset.exact = "no";
    if (!drawn) { drawn = true; requestAnimationFrame(painting); }
    clearTimeout(waiting);
    job?.abort();
    if (!state.rotating && !held.size) waiting = setTimeout(settle, STILL_MS);
  }
  async function settle() {
    if (gone || !scene) return;
    job = new AbortController();
    const mine = job;
    stage.classList.add("works");
    try {
      const answer = await ask("picture", {}, mine.signal);
      const address = URL.createObjectURL(answer);
      if (mine.signal.aborted) return URL.revokeObjectURL(address);
      const former = exact.src;
      exact.src = address;
      await exact.decode().catch(() => {});
      if (former) URL.revokeObjectURL(former);
      if (mine.signal.aborted) return;
      stage.classList.remove("moves");
      stage.dataset.exact = "yes";
      over();
      if (at("error").hidden) say("");
    } catch (error) { failed(error); } finally { if (mine === job) stage.classList.remove("works"); }
  }
  function turn(now) {
    const passed = from ? Math.min(now - from, 100) : 0;
    from = state?.rotating ? now : 0;
    if (state?.rotating && passed && !gone) change({ azimuth: state.azimuth + (0.5 * passed) / 1000 });
    if (state?.rotating) requestAnimationFrame(turn);
  }

  // --- films ----------------------------------------------------------------------------------------------------------
  let playing = false, fps = 0, run = 0;
  async function frame(number) {
    job?.abort();
    clearTimeout(waiting);
    job = new AbortController();
    const mine = job;
    const address = URL.createObjectURL(await ask("frame", { frame: number - 1 }, mine.signal));
    if (mine.signal.aborted) { URL.revokeObjectURL(address); throw new Superseded(); }
    const former = exact.src;
    exact.src = address;
    await exact.decode().catch(() => {});
    if (former) URL.revokeObjectURL(former);
    if (mine.signal.aborted) throw new Superseded();
    stage.classList.remove("moves", "works", "night");
    clear(at("over"));
    at("frame").value = number;
    root.querySelector("output[for=frame]").textContent = number;
    stage.dataset.frame = number;
  }
  async function play() {
    playing = !playing;
    const mine = ++run;
    if (state.rotating) press("f");
    at("play").setAttribute("aria-pressed", playing);
    try {
      while (playing && mine === run && !gone) {
        const began = performance.now(), now = Number(at("frame").value);
        await frame(now < Number(at("frame").max) ? now + 1 : 1);
        await new Promise((done) => { setTimeout(done, Math.max(0, 1000 / fps - (performance.now() - began))); });
      }
    } catch (error) { failed(error); } finally {
      if (mine === run) { playing = false; at("play").setAttribute("aria-pressed", false); }
    }
  }
  at("play").addEventListener("click", play);
  at("frame").addEventListener("input", () => { playing = false; frame(Number(at("frame").value)).catch(failed); });
  const recording = recorder(root, {
    state: () => state,
    make: (values, signal, progress) => program.movie({ state, text, ...values }, signal, progress),
    say,
    save: download,
  });

  // --- keys -----------------------------------------------------------------------------------------------------------
  const pending = [];
  let sending = false;
  async function press(key) {
    pending.push(key);
    if (sending) return;
    sending = true;
    try {
      while (pending.length && !gone) {
        const keys = pending.splice(0, pending.length);
        const about = state, answer = await asJson(ask("keys", { keys }));
        const rotated = answer.state.rotating && !state.rotating;
        answered(about, answer.state);
        if (rotated) requestAnimationFrame(turn);
        for (const wish of answer.wishes) await fulfil(wish);
      }
    } catch (error) { told(error); } finally { sending = false; }
  }
  async function fulfil(wish) {
    if (wish === "ps") await save("ps");
    if (wish === "video") recording.pressed();
    if (wish === "quit") await program.quit(say);
  }
  let known = {};
  program.keys.addEventListener("keydown", (event) => {
    if (!state || event.ctrlKey || event.metaKey || event.altKey || at("keys").open) return;
    const here = event.target;
    if (here.id === "text") { if (event.key === "Escape") stage.focus(); return; }
    const arrow = event.key.startsWith("Arrow");
    if ((arrow || event.key === "Escape") && here !== stage && here !== document.body) return;
    if (here.tagName === "SELECT") return;
    if (event.key === "?") { event.preventDefault(); return at("help").click(); }
    if (!(event.key in known)) return;
    event.preventDefault();
    press(event.key);
  });

  // --- mouse and fingers ----------------------------------------------------------------------------------------------
  const held = new Map();
  const shift = (dx, dy) => {
    const size = pictureHeight(state) / stage.clientHeight;
    const { right, up } = axesOf(state);
    change({ target: state.target.map((t, i) => t - size * (dx * right[i] - dy * up[i])) });
  };
  const larger = (factor) => {
    const fov = (360 / Math.PI) * Math.atan(Math.tan((state.fov_deg * Math.PI) / 360) / factor);
    change({ fov_deg: Math.min(fov, Math.max(150, state.fov_deg)) });
  };
  stage.addEventListener("pointerdown", (event) => {
    if (!scene) return;
    stage.setPointerCapture(event.pointerId);
    held.set(event.pointerId, [event.clientX, event.clientY]);
    stage.classList.add("held");
    stage.focus({ preventScroll: true, focusVisible: false });
  });
  stage.addEventListener("pointermove", (event) => {
    const before = held.get(event.pointerId);
    if (!before) return;
    const now = [event.clientX, event.clientY];
    const [dx, dy] = [now[0] - before[0], now[1] - before[1]];
    if (held.size === 2) {
      const other = [...held].find(([id]) => id !== event.pointerId)[1];
      const apart = (one) => Math.hypot(one[0] - other[0], one[1] - other[1]) || 1;
      shift(dx / 2, dy / 2);
      larger(apart(now) / apart(before));
    } else if (event.shiftKey || event.buttons & 6) shift(dx, dy);
    else change({ azimuth: state.azimuth - (Math.PI * dx) / stage.clientWidth, elevation: state.elevation + (Math.PI * dy) / stage.clientWidth });
    held.set(event.pointerId, now);
  });
  for (const over of ["pointerup", "pointercancel", "lostpointercapture"])
    stage.addEventListener(over, (event) => {
      if (!held.delete(event.pointerId)) return;
      if (!held.size) { stage.classList.remove("held"); move(); }
    });
  stage.addEventListener("contextmenu", (event) => event.preventDefault());
  stage.addEventListener("wheel", (event) => {
    event.preventDefault();
    if (scene) larger(Math.exp(-Math.max(-200, Math.min(200, event.deltaMode ? 30 * event.deltaY : event.deltaY)) / 700));
  }, { passive: false });

  // --- controls -------------------------------------------------------------------------------------------------------
  at("modes").addEventListener("change", (event) => {
    const goesOn = playing;
    change({ mode: event.target.value });
    if (goesOn) play();
  });
  for (const [id, field] of Object.entries(CHECKS)) at(id).addEventListener("change", () => change({ [field]: at(id).checked }));
  at("along").addEventListener("change", () => press(at("along").checked ? "G" : "g"));
  const radians = (value) => (value * Math.PI) / 180;
  const SLIDERS = { crease: (value) => ({ crease_angle_deg: value }), spacing: (value) => ({ spacing_mm: value }), "light-azimuth": (value) => ({ light_azimuth: radians(value) }), "light-elevation": (value) => ({ light_elevation: radians(value) }) };
  for (const [id, values] of Object.entries(SLIDERS)) at(id).addEventListener("input", () => change(values(Number(at(id).value))));
  at("hatch").addEventListener("change", () => change({ hatch: at("hatch").value }));
  for (const button of root.querySelectorAll("[data-key]")) button.addEventListener("click", () => press(button.dataset.key));
  at("rotate").addEventListener("click", () => press(state.rotating ? "f" : "F"));
  at("fit").addEventListener("click", async () => {
    try {
      const about = state;
      answered(about, (await asJson(ask("fit"))).state);
    } catch (error) { told(error); }
  });
  at("help").addEventListener("click", () => at("keys").showModal());
  at("save").addEventListener("click", () => save(at("format").value));
  at("copy").addEventListener("click", async () => {
    try {
      const { line } = await asJson(ask("command", { format: at("format").value }));
      // In some windows there is no clipboard, or the page may not write to it.
      await (navigator.clipboard?.writeText(line) ?? Promise.reject()).then(() => say(`Copied: ${line}`), () => say(line));
    } catch (error) { told(error); }
  });
  function download(blob, as) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = as;
    root.append(link);
    link.click();
    link.remove();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }
  const stem = () => name.replace(/\.[^.]*$/, "") || "picture";
  async function save(format) {
    say(`Making ${stem()}.${format} …`);
    try {
      download(await ask("save", { format }), `${stem()}.${format}`);
      say(`Saved ${stem()}.${format}`);
    } catch (error) { told(error); }
  }

  // --- the scene ------------------------------------------------------------------------------------------------------
  const area = at("text");
  function numbered(bad = 0) {
    const count = area.value.split("\n").length;
    at("numbers").replaceChildren(...Array.from({ length: count }, (_, k) => {
      const line = document.createElement("span");
      line.textContent = k + 1;
      if (k + 1 === bad) line.className = "bad";
      return [line, "\n"];
    }).flat());
    at("numbers").scrollTop = area.scrollTop;
  }
  area.addEventListener("scroll", () => { at("numbers").scrollTop = area.scrollTop; });
  let typed = 0;
  area.addEventListener("input", () => {
    numbered();
    clearTimeout(typed);
    typed = setTimeout(() => { written(area.value === fileText ? null : area.value); }, TYPED_MS);
  });
  function written(words) {
    text = words;
    program.keepText(text);
    at("as-file").disabled = text === null;
    load().then(move).catch(failed);
  }
  function failed(error) {
    if (!(error instanceof Refused)) return told(error);
    const ours = error.line && (!error.file || error.file.endsWith(name));
    at("error").textContent = ours ? `Line ${error.line}: ${error.message}` : error.message;
    at("error").hidden = false;
    if (at("scene-part").hidden) say(error.message);
    area.setAttribute("aria-invalid", "true");
    numbered(ours ? error.line : 0);
  }
  let loads = 0;
  async function load() {
    const mine = ++loads, answer = await ask("scene");
    const bytes = await answer.arrayBuffer();
    // A slower answer about an earlier text.
    if (mine !== loads) throw new Superseded();
    const size = new DataView(bytes).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, size)));
    const numbers = new Float32Array(bytes.slice(4 + size));
    const lines = numbers.subarray(0, 6 * head.segments);
    scene = { ...head, lines, boxLines: boxLines(numbers.subarray(6 * head.segments)), whole: boxLines(head.bounds.flat()) };
    at("error").hidden = true;
    area.removeAttribute("aria-invalid");
    numbered();
    at("colours").replaceChildren(...head.colours.map(([colour, shades]) => {
      const row = document.createElement("div"), label = document.createElement("span");
      label.textContent = colour;
      row.append(label, ...shades.map((shade) => { const patch = document.createElement("i"); patch.style.background = shade; return patch; }));
      return row;
    }));
    exact.alt = `${head.title || name}: ${head.items} items`;
  }
  at("as-file").addEventListener("click", () => { area.value = fileText; written(null); });
  at("save-scene").addEventListener("click", () => { download(new Blob([area.value], { type: "text/plain" }), name); say(`Saved ${name}`); });

  async function begin() {
    try {
      const start = await asJson(ask("start"));
      name = start.name;
      fileText = start.text;
      known = start.keys;
      fps = start.film.fps;
      at("copy").hidden = !start.file;
      at("film").hidden = !start.film.frames;
      at("frame").max = start.film.frames || 1;
      recording.offers(start.movies);
      at("name").textContent = name;
      program.titled(name);
      at("key-list").replaceChildren(...Object.entries(known).map(([key, says]) => {
        const row = document.createElement("div"), term = document.createElement("dt"), cap = document.createElement("kbd"), what = document.createElement("dd");
        cap.textContent = { ArrowLeft: "←", ArrowRight: "→", ArrowUp: "↑", ArrowDown: "↓", Escape: "Esc" }[key] ?? key;
        what.textContent = says;
        term.append(cap);
        row.append(term, what);
        return row;
      }));
      text = program.keptText();
      if (fileText === null) { text = null; at("scene-part").hidden = true; }
      area.value = text ?? fileText ?? "";
      at("as-file").disabled = text === null;
      numbered();
      try { await load(); } catch (error) {
        failed(error);
        if (text === null) return;
        const edited = text;
        text = null;
        await load();
        text = edited;
        failed(error);
      }
      const before = program.kept();
      let first = start.film.mode ? { ...scene.first, mode: start.film.mode } : scene.first;
      if (before) {
        try { first = (await asJson(ask("keys", { keys: [], state: before }))).state; } catch (error) { told(error); }
      }
      become(first);
      if (state.rotating) requestAnimationFrame(turn);
    } catch (error) { failed(error); }
  }
  let size = "";
  const resized = new ResizeObserver(() => {
    const now = `${root.clientWidth} ${innerHeight}`;
    if (now !== size && size && state) { sized(root, state, scene); move(); }
    size = now;
  });
  resized.observe(document.documentElement);
  resized.observe(root);
  begin();
  return {
    ended,
    goTo: (other) => { if (other && state && JSON.stringify(other) !== JSON.stringify(state)) become({ ...state, ...other }); },
    removed() { gone = true; resized.disconnect(); job?.abort(); clearTimeout(waiting); recording.removed(); },
  };
}
