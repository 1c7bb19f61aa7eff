// Buttons, keys, the charts as a time line; then the first picture.
function setNames(isShown) {
  showsNames = isShown;
  element("names").setAttribute("aria-pressed", isShown);
  redraw();
}

function setLoop(loops) {
  playback.loops = element("loop").checked = loops;
}

const keys = {
  " ": () => play(!playback.isPlaying),
  ArrowLeft: (event) => stepFrames(event.shiftKey ? -10 : -1),
  ArrowRight: (event) => stepFrames(event.shiftKey ? 10 : 1),
  ArrowUp: () => setSpeed(element("speed").selectedIndex + 1),
  ArrowDown: () => setSpeed(element("speed").selectedIndex - 1),
  Home: () => goTo(firstTime),
  End: () => goTo(lastTime),
  "+": () => zoom(1.25),
  "=": () => zoom(1.25),
  "-": () => zoom(0.8),
  f: () => fitView(),
  l: () => setLoop(!playback.loops),
  n: () => setNames(!showsNames),
};

document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const target = event.target, key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  // Space presses a focused button, arrows change a focused list: as everywhere.
  if (target.matches("select")) return;
  if (key === " " && target.matches("button, summary, [type=checkbox]")) return;
  if (!keys[key]) return;
  event.preventDefault();
  keys[key](event);
  redraw();
});

element("play").addEventListener("click", () => play(!playback.isPlaying));
element("scrub").addEventListener("input", (event) => goTo(+event.target.value));
element("speed").addEventListener("change", (event) => setSpeed(event.target.selectedIndex));
element("loop").addEventListener("change", (event) => setLoop(event.target.checked));
element("names").addEventListener("click", () => setNames(!showsNames));
element("fit").addEventListener("click", () => { fitView(); redraw(); });

for (const {canvas: chart} of charts) {
  const scrub = (event) => {
    if (event.type === "pointermove" && !(event.buttons & 1)) return;
    const box = chart.getBoundingClientRect(), inner = box.width - EDGE.left - EDGE.right;
    goTo(firstTime + duration * (event.clientX - box.left - EDGE.left) / inner);
  };
  chart.addEventListener("pointerdown", (event) => {
    chart.setPointerCapture(event.pointerId);
    scrub(event);
  });
  chart.addEventListener("pointermove", scrub);
}

window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
  colours = readColours();
  redraw();
});
new ResizeObserver(redraw).observe(document.body);
new ResizeObserver(redraw).observe(canvas);

element("scrub").min = firstTime;
element("scrub").max = lastTime;
element("speed").append(...speeds.map((speed) => new Option(`${show(speed)}×`)));
setSpeed(5);
setNames(showsNames);
showTraces();
play(!window.matchMedia("(prefers-reduced-motion: reduce)").matches);
