// The page of `vectorplot replay`: a film that plays again and again at its speed, and can be stopped and stepped through.
const at = (id) => document.getElementById(id);
const place = at("film"), frames = Number(place.dataset.frames), fps = Number(place.dataset.fps);

const text = await (await fetch("film.svg")).text();
const film = document.importNode(new DOMParser().parseFromString(text, "image/svg+xml").documentElement, true);
film.setAttribute("role", "img");
film.setAttribute("aria-label", document.title);
for (const side of ["width", "height"]) film.setAttribute(side, "100%");
place.append(film);

const frame = () => Math.floor(film.getCurrentTime() * fps + 1e-6) % frames;
function show() {
  at("frame").value = frame() + 1;
  document.querySelector("output[for=frame]").textContent = frame() + 1;
}
function pause(still) {
  if (still) film.pauseAnimations();
  else film.unpauseAnimations();
  at("pause").textContent = still ? "Play" : "Pause";
  show();
}
function goTo(number) {
  film.setCurrentTime((((number % frames) + frames) % frames + 0.5) / fps);
  pause(true);
}
at("pause").addEventListener("click", () => pause(!film.animationsPaused()));
at("frame").addEventListener("input", () => goTo(Number(at("frame").value) - 1));
const KEYS = { " ": () => pause(!film.animationsPaused()), ArrowRight: () => goTo(frame() + 1), ArrowLeft: () => goTo(frame() - 1), Home: () => goTo(0), End: () => goTo(frames - 1) };
document.addEventListener("keydown", (event) => {
  // The button and the slider have their own keys.
  if (!KEYS[event.key] || event.ctrlKey || event.metaKey || event.altKey || event.target.closest("button, input")) return;
  event.preventDefault();
  KEYS[event.key]();
});
function playing() {
  if (!film.animationsPaused()) show();
  requestAnimationFrame(playing);
}
playing();
pause(matchMedia("(prefers-reduced-motion: reduce)").matches);
