// Time: playing, scrubbing, speed; one picture is drawn whenever something has changed.
const playback = {t: firstTime, isPlaying: false, speed: 1, loops: true,
                  last: null,          // when the picture before was drawn, ms; null if paused
                  isAwaited: false};     // a picture is on its way
const shownTime = () => playback.t;
const decimals = clamp(4 - Math.floor(Math.log10(duration)), 1, 12);
const usualSpeed = duration >= 3 && duration <= 30 ? 1 : niceStep(duration / 14);
const speeds = [0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10]
  .map((x) => +(x * usualSpeed).toPrecision(3));

/// Asks for a picture; many requests before the next frame make one.
function redraw() {
  if (playback.isAwaited) return;
  playback.isAwaited = true;
  requestAnimationFrame((milliseconds) => {
    playback.isAwaited = false;
    advance(milliseconds);
    element("scrub").value = playback.t;
    element("time").textContent =
      `t = ${playback.t.toFixed(decimals)} of ${show(lastTime)} s`.replaceAll("-", "−");
    drawStage(playback.t);
    drawCharts(playback.t);
    if (playback.isPlaying) redraw();
  });
}

function advance(milliseconds) {
  const passed = playback.last === null ? 0 : Math.min(milliseconds - playback.last, 250) / 1000;
  playback.last = playback.isPlaying ? milliseconds : null;
  if (!playback.isPlaying) return;
  playback.t += passed * playback.speed;
  if (playback.t < lastTime) return;
  if (playback.loops) {
    playback.t = firstTime + (playback.t - firstTime) % duration;
  } else {
    playback.t = lastTime;
    play(false);
  }
}

function play(isPlaying) {
  if (isPlaying && playback.t >= lastTime) playback.t = firstTime;
  playback.isPlaying = isPlaying;
  playback.last = null;
  element("play-icon").setAttribute(
    "d", isPlaying ? "M6 4h4v16H6zM14 4h4v16h-4z" : "M7 4v16l13-8z");
  element("play").setAttribute("aria-label", isPlaying ? "Pause" : "Play");
  redraw();
}

function goTo(t) {
  playback.t = clamp(t, firstTime, lastTime);
  redraw();
}

function stepFrames(count) {
  play(false);
  goTo(times[clamp(nearestFrame(playback.t) + count, 0, times.length - 1)]);
}

function setSpeed(index) {
  element("speed").selectedIndex = clamp(index, 0, speeds.length - 1);
  playback.speed = speeds[element("speed").selectedIndex];
}
