// What the browser draws itself: lines while the picture moves, and what is shown over pictures.
import { pictureHeight, project, trace, turnedLights } from "./projection.js";

// The size of the page of a scene in what room there is.
export function sized(root, state, scene) {
  const stage = root.querySelector("#stage"), desk = root.querySelector("#desk"), style = getComputedStyle(desk);
  let { width, height } = scene.page;
  if (state.landscape && width < height) [width, height] = [height, width];
  const room = desk.clientWidth - 2 * parseFloat(style.paddingLeft);
  const wide = root.clientWidth > 860;
  const tall = wide ? desk.clientHeight - 2 * parseFloat(style.paddingTop) : 0.62 * innerHeight;
  const scale = Math.min(room / width, tall / height);
  stage.style.width = `${Math.floor(scale * width)}px`;
  stage.style.height = `${Math.floor(scale * height)}px`;
}

export function clear(canvas) {
  const ratio = devicePixelRatio || 1, { clientWidth: width, clientHeight: height } = canvas.parentElement;
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== w || canvas.height !== h) [canvas.width, canvas.height] = [w, h];
  const pen = canvas.getContext("2d");
  pen.setTransform(ratio, 0, 0, ratio, 0, 0);
  pen.clearRect(0, 0, width, height);
  return { pen, width, height };
}

function stroke({ pen, width, height }, state, lines, colour, thick) {
  pen.beginPath();
  trace(pen, state, lines, 0, lines.length / 6, width, height);
  pen.strokeStyle = colour;
  pen.lineWidth = thick;
  pen.stroke();
}

// The lines of a scene as they are while they move; of many some, and the box round everything.
export function paintMoving(canvas, state, scene) {
  const ground = clear(canvas);
  stroke(ground, state, scene.lines, state.mode === "wire" ? "#b9c0c8" : "#3a3a3a", 0.7);
  if (scene.thinned) stroke(ground, state, scene.whole, "#d9572b", 1);
}

// Boxes, axes and lights, as far as they are shown.
export function paintOver(canvas, state, scene) {
  const ground = clear(canvas), { pen, width, height } = ground;
  if (state.boxes) stroke(ground, state, scene.boxLines, "#1463c4", 0.8);
  pen.font = "600 12px system-ui, sans-serif";
  if (state.axes) {
    const reach = 0.6 * Math.hypot(...scene.bounds[1].map((high, i) => high - scene.bounds[0][i])) || 1;
    ["#c0392b", "#2e8b45", "#2a62c9"].forEach((colour, i) => {
      const end = [0, 0, 0];
      end[i] = reach;
      stroke(ground, state, new Float32Array([0, 0, 0, ...end]), colour, 1.6);
      const place = project(state, end, width, height);
      if (place) { pen.fillStyle = colour; pen.fillText("xyz"[i], place[0] + 4, place[1] - 4); }
    });
  }
  for (const light of state.lights ? turnedLights(state, scene.lights, scene.bounds) : []) {
    const place = project(state, light.at, width, height);
    if (!place) continue;
    stroke(ground, state, new Float32Array([...light.at, ...light.middle]), "rgb(200 140 0 / .55)", 1);
    pen.beginPath();
    pen.arc(place[0], place[1], 6, 0, 2 * Math.PI);
    pen.fillStyle = "#ffc933";
    pen.fill();
    pen.strokeStyle = "#7a5200";
    pen.stroke();
    pen.fillStyle = "#7a5200";
    pen.fillText(light.name, place[0] + 9, place[1] + 4);
  }
}
