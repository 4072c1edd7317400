"use strict";
// Charts of the page: bars by order, paths, curves over an angle, and stars. Each draws into an svg element; colours
// are classes of the style sheet. Vectors are [x, y] with x upwards and y to the right.
const Charts = (() => {
  const { number } = Tables;
  const NS = "http://www.w3.org/2000/svg";
  const TURN = 2 * Math.PI;
  const PATH_STEPS = 180;                                     // of a revolution
  const size = ([x, y]) => Math.hypot(x, y);
  const largestOf = (points) => Math.max(0, ...points.map(size));

  // ------------------------------------------------------------------ elements
  function element(name, attributes, parent, text) {
    const made = document.createElementNS(NS, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    if (parent) parent.append(made);
    return made;
  }
  // Empties an svg, and returns a function that puts elements into it.
  function clear(svg, width, height) {
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    return (name, attributes, text) => element(name, attributes, svg, text);
  }
  function pathOf(points) {
    if (!points.length) return "";
    return `M${points.map(([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join("L")}`;
  }
  // Widths are measured once: a browser that is asked for one lays out the whole page first.
  let widths = new WeakMap();
  const forgetWidths = () => { widths = new WeakMap(); };
  // Paper has a width of its own, which cannot be measured beforehand: charts have their usual width there.
  let isOnPaper = false;
  const drawForPaper = (value) => { isOnPaper = value; };
  function widthOf(svg, usual) {
    if (isOnPaper) return usual;
    if (!widths.has(svg)) widths.set(svg, svg.clientWidth || usual);
    return widths.get(svg);
  }

  // ------------------------------------------------------------------ vectors over a revolution
  // Value of a vector whose orders have phasors that turn with the crank and against it: rows of [order, forward, backward].
  function vectorAt(rows, theta) {
    let x = 0;
    let y = 0;
    for (const [n, [ax, ay], [bx, by]] of rows) {
      const c = Math.cos(n * theta);
      const s = Math.sin(n * theta);
      x += (ax + bx) * c + (by - ay) * s;
      y += (ay + by) * c + (ax - bx) * s;
    }
    return [x, y];
  }
  const tracePath = (rows) => Array.from({ length: PATH_STEPS + 1 }, (_, k) => vectorAt(rows, TURN * k / PATH_STEPS));

  // ------------------------------------------------------------------ bars by order
  const ROW = 58;                                             // height of a row
  const BAR = 10;                                             // height of a bar
  const LINE = 13;                                            // height of a line of small text
  const LETTER = 5.9;                                         // width of a small letter
  const NARROWEST = 260;
  const MOST_LETTERS = 16;                                    // of figures before and after; longer ones need more room
  const MORE_ROOM = 40;

  // Rows: { order, before, after, told, cure }; before and after are sizes [with the crank, against it], told the texts
  // before and after. A row without sizes is balanced.
  function drawBars(svg, rows, largest) {
    const width = Math.max(widthOf(svg, 520), NARROWEST);
    const left = chooseRoomOfFigures(width, rows);
    const room = width - left - 6;
    const put = clear(svg, width, rows.length * ROW);
    svg.style.height = `${rows.length * ROW}px`;
    rows.forEach((row, k) => {
      const top = k * ROW;
      const lengthOf = (value) => room * value / (largest || 1);
      put("text", { class: "order", x: 2, y: top + 19 }, String(row.order));
      putFigures(put("text", { class: "figure", x: left - 10, y: top + 19, "text-anchor": "end" }), row.told);
      if (row.before) putBar(put, "before", left, top + 6, row.before.map(lengthOf));
      if (row.after) putBar(put, "now", left, top + 7 + BAR, row.after.map(lengthOf));
      fold(row.cure, room / LETTER).forEach((line, n) =>
        put("text", { class: "cap cure", x: left, y: top + 40 + n * LINE }, line));
      put("path", { class: "axis", d: `M0 ${top + ROW - 1}H${width}` });
    });
  }
  function chooseRoomOfFigures(width, rows) {
    const longest = Math.max(...rows.map(({ told }) => told.join(" → ").length));
    const more = longest > MOST_LETTERS ? MORE_ROOM : 0;
    if (width < 400) return 164 + more;
    return (width < 480 ? 180 : 205) + more;
  }
  function putFigures(text, [before, after]) {
    const isBalanced = (figure) => figure === Tables.BALANCED;
    element("tspan", { class: isBalanced(before) ? "ok" : "" }, text, before);
    if (after === undefined) return;
    element("tspan", { class: "soft" }, text, " → ");
    element("tspan", { class: isBalanced(after) ? "ok strong" : "now strong" }, text, after);
  }
  function putBar(put, kind, x, y, [ahead, against]) {
    put("rect", { class: `bar ${kind}`, x, y, width: ahead, height: BAR });
    put("rect", { class: `bar ${kind} against`, x: x + ahead, y, width: against, height: BAR, fill: `url(#hatch-${kind})` });
  }
  // Lines of a text, at most two, of about this many characters.
  function fold(text, most) {
    const cut = text.length > most ? text.lastIndexOf(" ", most) : -1;
    const lines = cut < 0 ? [text] : [text.slice(0, cut), text.slice(cut + 1)];
    return lines.filter(Boolean);
  }

  // ------------------------------------------------------------------ path
  const SMALL = 120;                                          // a smaller picture has no texts
  const ENLARGED = 20;                                        // how much smaller a path is that is drawn larger, too

  // Paths: { before, now, file }, points of each; names of the axes up and right; texts of the largest values.
  function drawPath(svg, paths, { names, labels = {}, theta = null, rows = null, wide = 300 }) {
    const put = clear(svg, wide, wide);
    const middle = wide / 2;
    const isSmall = wide < SMALL;
    const drawn = ["file", "before", "now"].filter((kind) => paths[kind]);
    const most = Math.max(...drawn.map((kind) => largestOf(paths[kind]))) || 1;
    const reach = middle - (isSmall ? 4 : 26);
    const placeIn = (scale) => ([x, y]) => [middle + y * scale, middle - x * scale];
    const place = placeIn(reach / most);
    put("path", { class: "axis", d: `M4 ${middle}H${wide - 4}M${middle} 4V${wide - 4}` });
    if (!isSmall) putAxes(put, wide, reach, names);
    for (const kind of drawn) put("path", { class: kind, d: pathOf(paths[kind].map(place)) });
    if (labels.before) put("text", { class: "lab before", x: 8, y: 20 }, labels.before);
    if (labels.now) put("text", { class: "lab now", x: 8, y: 38 }, labels.now);
    const factor = paths.now && !isSmall ? chooseFactor(most / (largestOf(paths.now) || most)) : 0;
    if (factor) {
      put("path", { class: "now thin", d: pathOf(paths.now.map(placeIn(reach / most * factor))) });
      put("text", { class: "cap now", x: 8, y: wide - 8 }, `thin: ${factor} times enlarged`);
    }
    if (rows) {
      const [cx, cy] = place(vectorAt(rows, theta));
      put("circle", { class: "shake dot", cx, cy, r: 4 });
    }
    return { place, put };
  }
  function putAxes(put, wide, reach, [up, right]) {
    const middle = wide / 2;
    put("circle", { class: "axis", cx: middle, cy: middle, r: reach });
    const edge = wide - 6;                                    // in the corners, where no path goes
    put("text", { class: "cap", x: edge, y: 14, "text-anchor": "end" }, `↑ ${up}`);
    put("text", { class: "cap", x: edge, y: edge, "text-anchor": "end" }, `→ ${right}`);
  }
  // By how much a path is enlarged in addition, if it is this much smaller than the largest; 0: not.
  function chooseFactor(ratio) {
    if (ratio < ENLARGED) return 0;
    const power = 10 ** Math.floor(Math.log10(ratio / 2));
    return [5 * power, 2 * power, power].find((factor) => factor <= ratio / 1.6);
  }

  // ------------------------------------------------------------------ curves over an angle
  const WIDEST = 720;
  const PLOT_HIGH = 180;
  const LEFT = 62;
  const RIGHT = 18;
  const BELOW = 44;
  const NAME_WIDE = 170;                                      // room of a name in the legend
  const NAME_HIGH = 16;

  // Lines: { name, kind, values } at equal steps from 0 to `end` deg; the value at the pointer, or at the arrow keys,
  // is written for all lines at once.
  function drawCurves(svg, { lines, end, unit, across = "crank angle, deg" }) {
    const frame = frameCurves(Math.min(widthOf(svg, WIDEST), WIDEST), lines, end);
    const put = clear(svg, frame.wide, frame.high);
    putScales(put, frame, end);
    put("text", { class: "cap", x: 4, y: 14 }, unit);
    put("text", { class: "cap", x: (LEFT + frame.wide - RIGHT) / 2, y: frame.high - 6, "text-anchor": "middle" }, across);
    lines.forEach((line, k) => putLine(put, frame, line, k));
    svg.curves = { lines, end, frame, tip: element("g", { class: "tip" }, svg) };
    if (!svg.isPrepared) preparePointer(svg);
  }
  // Where values and angles stand: a frame with room at its ends, and a legend of as many rows as its width needs.
  function frameCurves(wide, lines, end) {
    const values = [0, ...lines.flatMap((line) => line.values)];
    const most = Math.max(...values);
    const least = Math.min(...values);
    const room = (most - least || 1) * 0.06;
    const high = most + room;
    const low = least < 0 ? least - room : 0;
    const columns = Math.max(1, Math.floor((wide - LEFT - 44) / NAME_WIDE));
    const top = 10 + NAME_HIGH * Math.ceil(lines.length / columns);
    return {
      end,
      wide,
      high: top + PLOT_HIGH + BELOW,
      top,
      bottom: top + PLOT_HIGH,
      columns,
      values: { low, high },
      xOf: (angle) => LEFT + (wide - LEFT - RIGHT) * angle / end,
      yOf: (value) => top + PLOT_HIGH * (high - value) / (high - low),
    };
  }
  function putScales(put, { wide, bottom, values: { low, high }, xOf, yOf }, end) {
    for (const value of chooseTicks(low, high)) {
      put("path", { class: "axis", d: `M${LEFT} ${yOf(value)}H${wide - RIGHT}` });
      put("text", { class: "cap", x: LEFT - 8, y: yOf(value) + 4, "text-anchor": "end" }, number(value, 6));
    }
    const step = end > 360 ? 120 : 60;
    for (let angle = 0; angle <= end; angle += step) {
      put("text", { class: "cap", x: xOf(angle), y: bottom + 18, "text-anchor": "middle" }, `${angle}°`);
    }
  }
  // Round values from the least to the most, about `count` of them.
  function chooseTicks(least, most, count = 5) {
    const rough = (most - least || 1) / count;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((k) => k * power).find((value) => value >= rough * 0.999999);
    const first = Math.ceil(least / step - 1e-9);
    const last = Math.floor(most / step + 1e-9);
    return Array.from({ length: last - first + 1 }, (_, k) => (first + k) * step);
  }
  function putLine(put, { end, columns, xOf, yOf }, { name, kind, values }, k) {
    const points = values.map((value, row) => [xOf(end * row / (values.length - 1)), yOf(value)]);
    put("path", { class: `line ${kind}`, d: pathOf(points) });
    const x = LEFT + 44 + (k % columns) * NAME_WIDE;
    const y = 10 + Math.floor(k / columns) * NAME_HIGH;
    put("path", { class: `line ${kind}`, d: `M${x} ${y}h24` });
    put("text", { class: "cap", x: x + 30, y: y + 4 }, name);
  }
  // Shows the values of all lines at an angle.
  function point(svg, angle) {
    const { lines, end, frame: { wide, top, bottom, xOf, yOf }, tip } = svg.curves;
    const values = lines.map((line) => valueAt(line.values, angle / end));
    const texts = lines.map(({ name }, k) => `${name} ${number(values[k])}`);
    const x = xOf(angle);
    tip.replaceChildren();
    element("path", { class: "hair", d: `M${x} ${top}V${bottom}` }, tip);
    lines.forEach(({ kind }, k) => element("circle", { class: `dot ${kind}`, cx: x, cy: yOf(values[k]), r: 4 }, tip));
    const room = 30 + 6.4 * Math.max(...texts.map((text) => text.length));
    const left = Math.min(x + 10, wide - RIGHT - room);
    element("rect", { x: left, y: top + 2, width: room, height: 22 + 16 * texts.length, rx: 4 }, tip);
    const rows = [`${Math.round(angle)}°`, ...texts];
    rows.forEach((text, k) => element("text", { x: left + 10, y: top + 18 + 16 * k }, tip, text));
    svg.told = `${Math.round(angle)}°: ${texts.join(", ")}`;
    svg.setAttribute("aria-label", `${svg.dataset.title}, ${svg.told}`);
  }
  function valueAt(values, share) {
    const at = share * (values.length - 1);
    const k = Math.min(Math.floor(at), values.length - 2);
    return values[k] + (values[k + 1] - values[k]) * (at - k);
  }
  function preparePointer(svg) {
    let angle = 0;
    const show = (next) => {
      angle = Math.min(Math.max(next, 0), svg.curves.end);
      point(svg, angle);
    };
    svg.isPrepared = true;
    svg.setAttribute("aria-label", svg.dataset.title);
    svg.setAttribute("tabindex", "0");
    svg.addEventListener("pointermove", ({ clientX }) => {
      const { end, frame: { wide } } = svg.curves;
      const box = svg.getBoundingClientRect();
      const x = wide * (clientX - box.left) / box.width;
      show(end * (x - LEFT) / (wide - LEFT - RIGHT));
    });
    svg.addEventListener("keydown", (event) => {
      const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!way) return;
      event.preventDefault();
      show(angle + (event.shiftKey ? 10 * way : way));
    });
  }

  // ------------------------------------------------------------------ star and polygon
  const STAR = { wide: 300, high: 150, left: [75, 75], right: [225, 75], reach: 52, span: 120 };
  const MOST_LABELS = 4;                                      // of rays with one tip

  // Rays: { vector, label, bank }; on the left from one point, on the right one after the other; dashed: their sum.
  function drawStar(svg, rays) {
    const put = clear(svg, STAR.wide, STAR.high);
    putRays(put, rays);
    putPolygon(put, rays);
  }
  const classOf = (bank) => `ray bank${bank % 3}`;
  function putRays(put, rays) {
    const [left, top] = STAR.left;
    const scale = STAR.reach / (largestOf(rays.map(({ vector }) => vector)) || 1);
    const labels = new Map();                                 // of rays with one tip
    for (const { vector: [x, y], label, bank } of rays) {
      const tip = [left + y * scale, top - x * scale];
      const place = tip.map((value) => value.toFixed(0)).join();
      put("path", { class: classOf(bank), d: `M${STAR.left}L${tip}` });
      labels.set(place, { tip, texts: [...(labels.get(place)?.texts || []), label] });
    }
    for (const { tip, texts } of labels.values()) {
      const [x, y] = [tip[0] - left, tip[1] - top];
      const beyond = 13 / (Math.hypot(x, y) || 1);
      const text = texts.length > MOST_LABELS ? `${texts.slice(0, 3).join()}…` : texts.join();
      put("text", { class: "n", x: tip[0] + beyond * x, y: tip[1] + beyond * y + 4 }, text);
    }
  }
  function putPolygon(put, rays) {
    const corners = [[0, 0]];
    for (const { vector: [x, y] } of rays) corners.push([corners.at(-1)[0] + x, corners.at(-1)[1] + y]);
    const ends = [0, 1].map((axis) => {
      const values = corners.map((corner) => corner[axis]);
      return { least: Math.min(...values), most: Math.max(...values) };
    });
    const scale = STAR.span / (Math.max(...ends.map(({ least, most }) => most - least)) || 1);
    const [middleX, middleY] = ends.map(({ least, most }) => (least + most) / 2);
    const [left, top] = STAR.right;
    const place = ([x, y]) => [left + (y - middleY) * scale, top - (x - middleX) * scale];
    rays.forEach(({ bank }, k) => put("path", { class: classOf(bank), d: pathOf([place(corners[k]), place(corners[k + 1])]) }));
    const sum = corners.at(-1);
    const [cx, cy] = place(sum);
    const isBalanced = size(sum) < 1e-9 * (largestOf(rays.map(({ vector }) => vector)) || 1);
    if (isBalanced) put("circle", { class: "closing dot", cx, cy, r: 4 });
    else put("path", { class: "closing", d: pathOf([place([0, 0]), [cx, cy]]) });
  }

  // ------------------------------------------------------------------ files
  const STYLED = [
    "fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-linecap", "opacity",
    "font-size", "font-weight", "font-family", "text-anchor",
  ];
  const PNG_SCALE = 2;

  // The text of a chart as a file of its own: all colours are written out.
  function writeSvg(svg) {
    const copy = copyPainted(svg);
    const { width, height } = svg.viewBox.baseVal;
    copy.prepend(copyPainted(document.querySelector("#hatches defs")));
    copy.setAttribute("xmlns", NS);
    copy.setAttribute("width", width);
    copy.setAttribute("height", height);
    copy.removeAttribute("style");
    return `<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(copy)}`;
  }
  function copyPainted(part) {
    const copy = part.cloneNode(true);
    const sources = [...part.querySelectorAll("*")];
    [...copy.querySelectorAll("*")].forEach((made, k) => paint(made, sources[k]));
    return copy;
  }
  function paint(made, source) {
    const style = getComputedStyle(source);
    for (const name of STYLED) {
      const value = style.getPropertyValue(name);
      const isHatched = value.includes("url(") || made.getAttribute(name)?.startsWith("url");
      if (value && !isHatched) made.setAttribute(name, value);
    }
    made.removeAttribute("class");
  }
  function save(name, blob) {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
  const saveText = (name, text, type) => save(name, new Blob([text], { type }));
  // Saves a chart as a picture; the size of the file in the end.
  function savePng(svg, name) {
    const { width, height } = svg.viewBox.baseVal;
    const canvas = document.createElement("canvas");
    canvas.width = width * PNG_SCALE;
    canvas.height = height * PNG_SCALE;
    const image = new Image();
    return new Promise((done) => {
      image.onload = () => {
        const context = canvas.getContext("2d");
        context.fillStyle = getComputedStyle(document.body).backgroundColor;
        context.fillRect(0, 0, canvas.width, canvas.height);
        context.drawImage(image, 0, 0, canvas.width, canvas.height);
        canvas.toBlob((blob) => {
          save(name, blob);
          done(blob.size);
        });
      };
      image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(writeSvg(svg))}`;
    });
  }
  const writeCell = (cell) => /[",\n]/.test(cell) ? `"${String(cell).replaceAll('"', '""')}"` : cell;
  const writeCsv = (rows) => rows.map((row) => `${row.map(writeCell).join(",")}\n`).join("");

  // Buttons that save a figure: `find` returns its svg, `list` the rows of its CSV, with a header.
  function addTools(parent, name, find, list) {
    const makeButton = (text, act) => {
      const button = Tables.make("button", { type: "button", ariaLabel: `${text} of ${name}` }, text);
      button.addEventListener("click", () => act(`${nameEngine()}-${name}.${text.toLowerCase()}`));
      return button;
    };
    const buttons = [makeButton("CSV", (file) => saveText(file, writeCsv(list()), "text/csv"))];
    if (find) {
      buttons.unshift(
        makeButton("PNG", (file) => savePng(find(), file)),
        makeButton("SVG", (file) => saveText(file, writeSvg(find()), "image/svg+xml")),
      );
    }
    parent.append(Tables.make("span", { className: "tools" }, ...buttons));
  }
  const nameEngine = () => document.querySelector("h1").textContent.replace(/[^\w-]+/g, "_").slice(0, 40);

  return {
    ROW, forgetWidths, drawForPaper, element, vectorAt, tracePath,
    drawBars, drawPath, drawCurves, drawStar, addTools, writeSvg, writeCsv, savePng,
  };
})();
