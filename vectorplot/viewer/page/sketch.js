// The page of `vectorplot try sketch.py`: what a sketch draws, drawn again when the file or a parameter changes.
const at = (id) => document.getElementById(id);
const page = crypto.randomUUID(), EVERY_MS = 500;
let values = {}, known = [], stamp = "", picture = null, asking = 0;

try {
  values = JSON.parse(decodeURIComponent(location.hash.slice(1))) ?? {};
} catch {
  values = {};
}

async function ask(what, told) {
  const answer = await fetch(`ask/${what}`, { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify({ page, ...told }) });
  if (answer.status === 409) return null;
  const made = await answer.json();
  return answer.ok ? made : { error: made.cause };
}

function control(one) {
  const label = document.createElement("label"), name = document.createElement("span");
  label.className = one.kind === "bool" ? "check" : "slider";
  name.textContent = one.name;
  const input = document.createElement(one.kind === "choice" ? "select" : "input");
  input.dataset.name = one.name;
  if (one.kind === "choice") input.append(...one.choices.map((word) => new Option(word, word)));
  else input.type = { bool: "checkbox", text: "text" }[one.kind] ?? (one.name === "seed" ? "number" : "range");
  const output = document.createElement("output");
  if (input.type === "range") {
    input.min = one.low;
    input.max = one.high;
    input.step = one.kind === "int" ? 1 : (one.high - one.low) / 200 || 1;
  }
  const value = values[one.name] ?? one.value;
  if (one.kind === "bool") input.checked = value;
  else input.value = value;
  const say = () => (output.textContent = input.type === "range" ? Number(Number(input.value).toPrecision(4)) : "");
  say();
  input.addEventListener("input", () => {
    values[one.name] = one.kind === "bool" ? input.checked : ["int", "float"].includes(one.kind) ? Number(input.value) : input.value;
    say();
    draw();
  });
  label.append(...(one.kind === "bool" ? [input, name] : [name, input, output]));
  return label;
}

function show(parameters) {
  const before = JSON.stringify(known);
  known = parameters;
  at("seed").hidden = !known.some((one) => one.name === "seed" && one.kind === "int");
  if (JSON.stringify(known) !== before) at("parameters").replaceChildren(...known.map(control));
}

async function draw() {
  const own = ++asking, began = performance.now();
  at("state").textContent = "drawing …";
  history.replaceState(null, "", `#${encodeURIComponent(JSON.stringify(values))}`);
  const made = await ask("sketch", { values });
  if (made === null || own !== asking) return;
  stamp = made.stamp ?? stamp;
  at("told").hidden = !made.error && !made.printed;
  at("error").hidden = !made.error;
  at("error").textContent = made.error ?? "";
  at("printed").textContent = made.printed ?? "";
  at("state").textContent = made.error ? "not drawn" : `drawn in ${((performance.now() - began) / 1000).toFixed(2)} s`;
  if (!made.picture) return;
  show(made.parameters);
  if (picture) URL.revokeObjectURL(picture.address);
  const bytes = Uint8Array.from(atob(made.picture), (letter) => letter.charCodeAt(0));
  picture = { address: URL.createObjectURL(new Blob([bytes], { type: made.kind })), end: made.kind.includes("svg") ? "svg" : "png" };
  at("picture").src = picture.address;
  at("save").disabled = false;
}

at("save").addEventListener("click", () => {
  const link = document.createElement("a");
  const seed = known.some((one) => one.name === "seed") ? `-${values.seed ?? known.find((one) => one.name === "seed").value}` : "";
  link.download = `${document.title.replace(/\.py$/, "")}${seed}.${picture.end}`;
  link.href = picture.address;
  link.click();
});
function again(changed) {
  values = changed;
  at("parameters").replaceChildren(...known.map(control));
  draw();
}
at("reset").addEventListener("click", () => again({}));
at("seed").addEventListener("click", () => again({ ...values, seed: Math.floor(Math.random() * 1e6) }));

async function watch() {
  try {
    const found = await ask("changed", {});
    if (found?.stamp && stamp && found.stamp !== stamp) await draw();
  } catch {
    at("state").textContent = "the program has ended";
  }
  setTimeout(watch, EVERY_MS);
}
await draw();
watch();
