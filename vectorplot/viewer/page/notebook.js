// The same viewer in a notebook, as a widget of anywidget: it asks the kernel by messages. PAGE and STYLE stand before this.
import { Refused, Superseded } from "./program.js";
import { viewer } from "./viewer.js";

const KEPT_MS = 150;

function render({ model, el }) {
  const host = document.createElement("div");
  const shadow = host.attachShadow({ mode: "open" });
  const style = new CSSStyleSheet();
  style.replaceSync(STYLE);
  shadow.adoptedStyleSheets = [style];
  shadow.innerHTML = PAGE;
  el.append(host);

  const page = `${Date.now()}${Math.random()}`, waiting = new Map();
  let asked = 0, keeping = 0, text = null;
  function heard(message, buffers) {
    const waits = waiting.get(message.id);
    if (!waits) return;
    if (message.of) return waits.progress?.(message.done, message.of);
    waiting.delete(message.id);
    if (message.superseded) waits.reject(new Superseded());
    else if (message.cause) waits.reject(new Refused(message));
    else waits.resolve({ name: message.name, blob: new Blob(buffers ?? [], { type: message.kind }) });
  }
  const question = (what, values, signal, progress) => new Promise((resolve, reject) => {
    if (signal?.aborted) return reject(new Superseded());
    const id = `${page} ${++asked}`;
    waiting.set(id, { resolve, reject, progress });
    signal?.addEventListener("abort", () => {
      if (!waiting.delete(id)) return;
      model.send({ page, what, stop: true });
      reject(new Superseded());
    }, { once: true });
    model.send({ id, page, what, asked: values });
  });

  const root = shadow.querySelector(".viewer");
  // The notebook has keys of its own, which are not meant here.
  host.addEventListener("keydown", (event) => event.stopPropagation());
  model.on("msg:custom", heard);
  const shown = viewer(root, {
    ask: async (...given) => (await question(...given)).blob,
    movie: async (...given) => {
      const made = await question("movie", ...given);
      return { name: made.name, blob: made.blob.size ? made.blob : null };
    },
    keys: root,
    keep(state) {
      clearTimeout(keeping);
      keeping = setTimeout(() => { model.set("state", state); model.save_changes(); }, KEPT_MS);
    },
    kept: () => model.get("state"),
    keepText(words) { text = words; },
    keptText: () => text,
    titled() {},
    quit: () => root.querySelector("#stage").blur(),
  });
  const follow = () => shown.goTo(model.get("state"));
  model.on("change:state", follow);
  return () => {
    clearTimeout(keeping);
    model.off("change:state", follow);
    model.off("msg:custom", heard);
    shown.removed();
  };
}

export default { render };
