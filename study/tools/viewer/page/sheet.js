// The contact sheet that `study/view --png` takes from a page: some instants of the motion beside each other.
const SHEET = {instants: 8, columns: 4, width: 480, title: 26};  // of a picture, pixels

function drawSheet() {
  const shape = isSpatial ? 0.75 : clamp(size[1] / (size[0] || radius), 0.4, 1.2);
  const height = Math.round(SHEET.width * shape), rowHeight = height + SHEET.title;
  const sheet = document.createElement("canvas"), ink = sheet.getContext("2d"), image = new Image();
  sheet.width = SHEET.columns * SHEET.width;
  sheet.height = SHEET.instants / SHEET.columns * rowHeight;
  canvas.style.cssText = `position: static; width: ${SHEET.width}px; height: ${height}px`;
  showsNames = false;
  ink.fillStyle = colours.paper;
  ink.fillRect(0, 0, sheet.width, sheet.height);
  ink.fillStyle = colours.ink;
  ink.strokeStyle = colours.line;
  ink.font = "15px system-ui, sans-serif";
  const digits = clamp(2 - Math.floor(Math.log10(duration)), 0, 12);
  for (let k = 0; k < SHEET.instants; ++k) {
    const t = firstTime + duration * k / (SHEET.instants - 1);
    const x = k % SHEET.columns * SHEET.width, y = Math.floor(k / SHEET.columns) * rowHeight;
    drawStage(t);
    ink.fillText(`${t.toFixed(digits)} s`, x + 8, y + SHEET.title - 8);
    ink.drawImage(canvas, x, y + SHEET.title, SHEET.width, height);
    ink.strokeRect(x + 0.5, y + SHEET.title + 0.5, SHEET.width - 1, height - 1);
  }
  image.id = "sheet";
  image.src = sheet.toDataURL();
  document.body.append(image);
}

if (data.sheet) drawSheet();
