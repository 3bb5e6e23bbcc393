// How points of the world come onto the page while the picture moves: the camera of the state, as the program has it.

export function axesOf(state) {
  const [ca, sa] = [Math.cos(state.azimuth), Math.sin(state.azimuth)];
  const [ce, se] = [Math.cos(state.elevation), Math.sin(state.elevation)];
  const [ct, st] = [Math.cos(state.twist), Math.sin(state.twist)];
  const right = [-sa, ca, 0];
  const up = [-se * ca, -se * sa, ce];
  return {
    right: right.map((r, i) => ct * r + st * up[i]),
    up: up.map((u, i) => ct * u - st * right[i]),
    back: [ce * ca, ce * sa, se],
  };
}

export function pictureHeight(state) {
  return 2 * state.distance * Math.tan((state.fov_deg * Math.PI) / 360);
}

// (n,6) ends of segments in the world -> their ends in pixels, on a path; what is behind the eye is cut off.
export function trace(path, state, lines, from, to, width, height) {
  const { right, up, back } = axesOf(state);
  const [tx, ty, tz] = state.target;
  const scale = height / pictureHeight(state);
  const d = state.distance;
  const near = d / 1000;
  for (let k = 6 * from; k < 6 * to; k += 6) {
    let ax = lines[k] - tx, ay = lines[k + 1] - ty, az = lines[k + 2] - tz;
    let bx = lines[k + 3] - tx, by = lines[k + 4] - ty, bz = lines[k + 5] - tz;
    let au = right[0] * ax + right[1] * ay + right[2] * az, av = up[0] * ax + up[1] * ay + up[2] * az;
    let bu = right[0] * bx + right[1] * by + right[2] * bz, bv = up[0] * bx + up[1] * by + up[2] * bz;
    if (!state.parallel) {
      let aw = d - (back[0] * ax + back[1] * ay + back[2] * az);
      let bw = d - (back[0] * bx + back[1] * by + back[2] * bz);
      if (aw < near && bw < near) continue;
      if (aw < near) { const t = (near - aw) / (bw - aw); au += t * (bu - au); av += t * (bv - av); aw = near; }
      if (bw < near) { const t = (near - bw) / (aw - bw); bu += t * (au - bu); bv += t * (av - bv); bw = near; }
      au *= d / aw; av *= d / aw; bu *= d / bw; bv *= d / bw;
    }
    path.moveTo(width / 2 + scale * au, height / 2 - scale * av);
    path.lineTo(width / 2 + scale * bu, height / 2 - scale * bv);
  }
}

// One point in pixels, or null behind the eye.
export function project(state, point, width, height) {
  const { right, up, back } = axesOf(state);
  const rest = point.map((p, i) => p - state.target[i]);
  const dot = (axis) => axis[0] * rest[0] + axis[1] * rest[1] + axis[2] * rest[2];
  const depth = state.parallel ? state.distance : state.distance - dot(back);
  if (depth <= 0) return null;
  const scale = (height / pictureHeight(state)) * (state.distance / depth);
  return [width / 2 + scale * dot(right), height / 2 - scale * dot(up)];
}

// Where lights are, turned about the middle of the scene.
export function turnedLights(state, lights, bounds) {
  const along = state.lights_go_along_from === null ? 0 : state.azimuth - state.lights_go_along_from;
  const middle = bounds[0].map((low, i) => (low + bounds[1][i]) / 2);
  const size = Math.hypot(...bounds[1].map((high, i) => high - bounds[0][i])) || 1;
  return lights.map((light) => {
    const rest = light.position.map((p, i) => (light.parallel ? p : p - middle[i]));
    const radius = Math.hypot(...rest);
    const azimuth = Math.atan2(rest[1], rest[0]) + state.light_azimuth + along;
    const elevation = Math.asin(rest[2] / radius) + state.light_elevation;
    const far = light.parallel ? 0.7 * size : radius;
    const flat = far * Math.cos(elevation);
    const offset = [flat * Math.cos(azimuth), flat * Math.sin(azimuth), far * Math.sin(elevation)];
    return { ...light, middle, at: middle.map((m, i) => m + offset[i]) };
  });
}

export function boxLines(boxes) {
  const edges = [];
  for (let k = 0; k < boxes.length; k += 6) {
    const corner = (n) => [0, 1, 2].map((axis) => boxes[k + axis + ((n >> axis) & 1 ? 3 : 0)]);
    for (let n = 0; n < 8; n++) for (const axis of [1, 2, 4]) if (!(n & axis)) edges.push(...corner(n), ...corner(n | axis));
  }
  return new Float32Array(edges);
}
