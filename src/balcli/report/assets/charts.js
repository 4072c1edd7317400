"use strict";
// Charts of the page: bars by order, paths, curves over an angle, and stars. Each draws into an svg element; colours
// are classes of the style sheet. Vectors are [x, y] with x upwards and y to the right.
const Charts = (() => {
  const { number } = Tables, TURN = 2 * Math.PI, NS = "http://www.w3.org/2000/svg";
  const PATH_STEPS = 180, WIDEST = 18, ROW = 58, BAR = 10, LINE = 13;
  const size = ([x, y]) => Math.hypot(x, y);

  // ------------------------------------------------------------------ elements
  function element(name, attributes, parent, text) {
    const made = document.createElementNS(NS, name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    if (parent) parent.append(made);
    return made;
  }
  function clear(svg, width, height) {
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    return (name, attributes, text) => element(name, attributes, svg, text);
  }
  const pathOf = (points) => points.length ? `M${points.map(([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join("L")}` : "";
  // Round values from the least to the most, about `count` of them.
  function chooseTicks(least, most, count = 5) {
    const rough = (most - least || 1) / count, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((k) => k * power).find((v) => v >= rough * 0.999999);
    const from = Math.ceil(least / step - 1e-9), to = Math.floor(most / step + 1e-9);
    return Array.from({ length: to - from + 1 }, (_, k) => (from + k) * step);
  }

  // ------------------------------------------------------------------ vectors over a revolution
  // Value of a vector whose orders have phasors that turn with the crank and against it: rows of [order, forward, backward].
  function vectorAt(rows, theta) {
    let x = 0, y = 0;
    for (const [n, [ax, ay], [bx, by]] of rows) {
      const c = Math.cos(n * theta), s = Math.sin(n * theta);
      x += (ax + bx) * c + (by - ay) * s;
      y += (ay + by) * c + (ax - bx) * s;
    }
    return [x, y];
  }
  const tracePath = (rows) => Array.from({ length: PATH_STEPS + 1 }, (_, k) => vectorAt(rows, TURN * k / PATH_STEPS));
  const largestOf = (points) => Math.max(0, ...points.map(size));

  // ------------------------------------------------------------------ bars by order
  // Widths are measured once: a browser that is asked for one lays out the whole page first.
  let widths = new WeakMap();
  const forgetWidths = () => { widths = new WeakMap(); };
  function widthOf(svg) {
    if (!widths.has(svg)) widths.set(svg, Math.max(svg.clientWidth || 520, 260));
    return widths.get(svg);
  }
  // Rows: { order, before, after, told, cure }; before and after are sizes [with the crank, against it], told the texts
  // before and after. A row without sizes is balanced.
  function drawBars(svg, rows, largest) {
    const width = widthOf(svg), longest = Math.max(...rows.map(({ told }) => told.join(" → ").length));
    const usual = width < 400 ? 164 : width < 480 ? 180 : 205, left = longest > WIDEST ? usual + 40 : usual, room = width - left - 6;
    const put = clear(svg, width, rows.length * ROW);
    svg.style.height = `${rows.length * ROW}px`;
    rows.forEach((row, k) => {
      const top = k * ROW, length = (value) => room * value / (largest || 1);
      put("text", { class: "order", x: 2, y: top + 19 }, String(row.order));
      const figures = put("text", { class: "figure", x: left - 10, y: top + 19, "text-anchor": "end" });
      const changes = row.told.length > 1;
      element("tspan", { class: row.told[0] === Tables.BALANCED ? "ok" : "" }, figures, row.told[0]);
      if (changes) {
        element("tspan", { class: "soft" }, figures, " → ");
        element("tspan", { class: row.told[1] === Tables.BALANCED ? "ok strong" : "now strong" }, figures, row.told[1]);
      }
      [row.before, row.after].forEach((parts, which) => {
        const kind = which ? "now" : "before", y = top + 6 + which * (BAR + 1);
        if (!parts) return;
        put("rect", { class: `bar ${kind}`, x: left, y, width: length(parts[0]), height: BAR });
        put("rect", { class: `bar ${kind} against`, x: left + length(parts[0]), y, width: length(parts[1]), height: BAR, fill: `url(#hatch-${kind})` });
      });
      fold(row.cure, room / 5.9).forEach((line, n) =>
        put("text", { class: "cap cure", x: left, y: top + 40 + n * LINE }, line));
      put("path", { class: "axis", d: `M0 ${top + ROW - 1}H${width}` });
    });
  }
  // Lines of a text, at most two, of about this many characters.
  function fold(text, most) {
    const cut = text.length > most ? text.lastIndexOf(" ", most) : -1;
    return (cut < 0 ? [text] : [text.slice(0, cut), text.slice(cut + 1)]).filter(Boolean);
  }

  // ------------------------------------------------------------------ path
  // Paths: { before, now, file }, points of each; names of the axes up and right; texts of the largest values.
  function drawPath(svg, paths, { names, labels = {}, theta = null, rows = null, wide = 300 }) {
    const put = clear(svg, wide, wide), middle = wide / 2, small = wide < 120;
    const all = [paths.before, paths.now, paths.file].filter(Boolean), most = Math.max(...all.map(largestOf)) || 1;
    const reach = middle - (small ? 4 : 26), at = (scale) => ([x, y]) => [middle + y * scale, middle - x * scale], place = at(reach / most);
    put("path", { class: "axis", d: `M4 ${middle}H${wide - 4}M${middle} 4V${wide - 4}` });
    if (!small) {
      put("circle", { class: "axis", cx: middle, cy: middle, r: reach });
      put("text", { class: "cap", x: middle + 4, y: 14 }, names[0]);
      put("text", { class: "cap", x: wide - 4, y: middle - 5, "text-anchor": "end" }, names[1]);
    }
    for (const kind of ["file", "before", "now"]) if (paths[kind]) put("path", { class: kind, d: pathOf(paths[kind].map(place)) });
    if (labels.before) put("text", { class: "lab before", x: 8, y: 20 }, labels.before);
    if (labels.now) put("text", { class: "lab now", x: 8, y: 38 }, labels.now);
    const least = paths.now ? largestOf(paths.now) : 0, factor = chooseFactor(most / (least || most));
    if (!small && factor) {
      put("path", { class: "now thin", d: pathOf(paths.now.map(at(reach / most * factor))) });
      put("text", { class: "cap now", x: 8, y: wide - 8 }, `thin: ${factor} times enlarged`);
    }
    if (theta !== null && rows) {
      const [x, y] = place(vectorAt(rows, theta));
      put("circle", { class: "shake dot", cx: x, cy: y, r: 4 });
    }
    return { place, put };
  }
  // By how much a path is enlarged in addition, if it is smaller than 1/20 of the other; 0: not.
  function chooseFactor(ratio) {
    if (ratio < 20) return 0;
    const power = 10 ** Math.floor(Math.log10(ratio / 2));
    return [5, 2, 1].map((k) => k * power).find((k) => k <= ratio / 1.6);
  }

  // ------------------------------------------------------------------ curves over an angle
  // Lines: { name, kind, values } at equal steps from 0 to `end` deg; the value at the pointer, or at the arrow keys,
  // is written for all lines at once.
  function drawCurves(svg, { lines, end, unit, across = "crank angle, deg" }) {
    const WIDE = 720, HIGH = 250, LEFT = 62, RIGHT = 18, TOP = 26, BOTTOM = 44, put = clear(svg, WIDE, HIGH);
    const all = [0, ...lines.flatMap(({ values }) => values)], most = Math.max(...all), least = Math.min(...all), room = (most - least || 1) * 0.06;
    const [high, low] = [most + room, least < 0 ? least - room : 0], xOf = (angle) => LEFT + (WIDE - LEFT - RIGHT) * angle / end;
    const yOf = (value) => TOP + (HIGH - TOP - BOTTOM) * (high - value) / (high - low);
    for (const value of chooseTicks(low, high)) {
      put("path", { class: "axis", d: `M${LEFT} ${yOf(value)}H${WIDE - RIGHT}` });
      put("text", { class: "cap", x: LEFT - 8, y: yOf(value) + 4, "text-anchor": "end" }, number(value, 6));
    }
    const step = end > 360 ? 120 : 60;
    for (let angle = 0; angle <= end; angle += step) put("text", { class: "cap", x: xOf(angle), y: HIGH - BOTTOM + 18, "text-anchor": "middle" }, `${angle}°`);
    put("text", { class: "cap", x: 4, y: 14 }, unit);
    put("text", { class: "cap", x: (LEFT + WIDE - RIGHT) / 2, y: HIGH - 6, "text-anchor": "middle" }, across);
    const points = (values) => values.map((value, k) => [xOf(end * k / (values.length - 1)), yOf(value)]);
    lines.forEach(({ name, kind, values }, k) => {
      put("path", { class: `line ${kind}`, d: pathOf(points(values)) });
      put("path", { class: `line ${kind}`, d: `M${LEFT + 44 + k * 170} 10h24` });
      put("text", { class: "cap", x: LEFT + 74 + k * 170, y: 14 }, name);
    });
    const tip = element("g", { class: "tip" }, svg);
    svg.point = (angle) => {
      tip.replaceChildren();
      const values = lines.map(({ values }) => valueAt(values, angle / end)), x = xOf(angle), told = lines.map(({ name }, k) => `${name} ${number(values[k])}`);
      element("path", { class: "hair", d: `M${x} ${TOP}V${HIGH - BOTTOM}` }, tip);
      lines.forEach(({ kind }, k) => element("circle", { class: `dot ${kind}`, cx: x, cy: yOf(values[k]), r: 4 }, tip));
      const wide = 30 + 6.4 * Math.max(...told.map((text) => text.length)), at = Math.min(x + 10, WIDE - RIGHT - wide);
      element("rect", { x: at, y: TOP + 2, width: wide, height: 22 + 16 * told.length, rx: 4 }, tip);
      [`${Math.round(angle)}°`, ...told].forEach((text, k) => element("text", { x: at + 10, y: TOP + 18 + 16 * k }, tip, text));
      svg.told = `${Math.round(angle)}°: ${told.join(", ")}`;
      svg.setAttribute("aria-label", `${svg.dataset.title}, ${svg.told}`);
    };
    if (svg.prepared) return;
    svg.prepared = true;
    svg.setAttribute("aria-label", svg.dataset.title);
    svg.setAttribute("tabindex", "0");
    let angle = 0;
    const show = (next) => { angle = Math.min(Math.max(next, 0), svg.end); svg.point(angle); };
    svg.addEventListener("pointermove", ({ clientX }) => {
      const box = svg.getBoundingClientRect(), x = WIDE * (clientX - box.left) / box.width;
      show(svg.end * (x - LEFT) / (WIDE - LEFT - RIGHT));
    });
    svg.addEventListener("keydown", (event) => {
      const way = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!way) return;
      event.preventDefault();
      show(angle + way * (event.shiftKey ? 10 : 1));
    });
    svg.end = end;
  }
  function valueAt(values, share) {
    const at = share * (values.length - 1), k = Math.min(Math.floor(at), values.length - 2);
    return values[k] + (values[k + 1] - values[k]) * (at - k);
  }

  // ------------------------------------------------------------------ star and polygon
  // Rays: { vector, label, bank }; on the left from one point, on the right one after the other; dashed: their sum.
  function drawStar(svg, rays) {
    const WIDE = 300, HIGH = 150, put = clear(svg, WIDE, HIGH), most = Math.max(...rays.map(({ vector }) => size(vector))) || 1;
    const from = [75, 75], scale = 52 / most, labels = new Map();
    for (const { vector: [x, y], label, bank } of rays) {
      const tip = [from[0] + y * scale, from[1] - x * scale], key = tip.map((v) => v.toFixed(0)).join();
      put("path", { class: `ray bank${bank % 3}`, d: `M${from}L${tip}` });
      labels.set(key, { tip, texts: [...(labels.get(key)?.texts || []), label] });
    }
    for (const { tip, texts } of labels.values()) {
      const [x, y] = [tip[0] - from[0], tip[1] - from[1]], long = Math.hypot(x, y) || 1, told = texts.length > 4 ? `${texts.slice(0, 3).join()}…` : texts.join();
      put("text", { class: "n", x: tip[0] + 13 * x / long, y: tip[1] + 13 * y / long + 4 }, told);
    }
    const corners = [[0, 0]];
    for (const { vector: [x, y] } of rays) corners.push([corners.at(-1)[0] + x, corners.at(-1)[1] + y]);
    const [xs, ys] = [0, 1].map((k) => corners.map((corner) => corner[k])), span = Math.max(Math.max(...xs) - Math.min(...xs), Math.max(...ys) - Math.min(...ys)) || 1;
    const middle = [xs, ys].map((each) => (Math.max(...each) + Math.min(...each)) / 2);
    const place = ([x, y]) => [225 + (y - middle[1]) * 120 / span, 75 - (x - middle[0]) * 120 / span];
    rays.forEach(({ bank }, k) => put("path", { class: `ray bank${bank % 3}`, d: pathOf([corners[k], corners[k + 1]].map(place)) }));
    const end = corners.at(-1);
    if (size(end) < 1e-9 * most) put("circle", { class: "closing dot", cx: place(end)[0], cy: place(end)[1], r: 4 });
    else put("path", { class: "closing", d: pathOf([[0, 0], end].map(place)) });
  }

  // ------------------------------------------------------------------ files
  const STYLED = ["fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-linecap", "opacity", "font-size", "font-weight", "font-family", "text-anchor"];
  // The text of a chart as a file of its own: all colours are written out.
  function writeSvg(svg) {
    const copy = copyPainted(svg), box = svg.viewBox.baseVal;
    copy.prepend(copyPainted(document.querySelector("#hatches defs")));
    copy.setAttribute("xmlns", NS);
    copy.setAttribute("width", box.width);
    copy.setAttribute("height", box.height);
    copy.removeAttribute("style");
    return `<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(copy)}`;
  }
  function copyPainted(part) {
    const copy = part.cloneNode(true), sources = [...part.querySelectorAll("*")];
    [...copy.querySelectorAll("*")].forEach((made, k) => paint(made, sources[k]));
    return copy;
  }
  function paint(made, source) {
    const style = getComputedStyle(source);
    for (const name of STYLED) {
      const value = style.getPropertyValue(name);
      if (value && !value.includes("url(") && !made.getAttribute(name)?.startsWith("url")) made.setAttribute(name, value);
    }
    made.removeAttribute("class");
  }
  function save(name, content, type) {
    const link = document.createElement("a");
    link.href = content instanceof Blob ? URL.createObjectURL(content) : URL.createObjectURL(new Blob([content], { type }));
    link.download = name;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
  function savePng(svg, name) {
    const box = svg.viewBox.baseVal, image = new Image(), canvas = document.createElement("canvas"), scale = 2;
    Object.assign(canvas, { width: box.width * scale, height: box.height * scale });
    return new Promise((done) => {
      image.onload = () => {
        const context = canvas.getContext("2d");
        context.fillStyle = getComputedStyle(document.body).backgroundColor;
        context.fillRect(0, 0, canvas.width, canvas.height);
        context.drawImage(image, 0, 0, canvas.width, canvas.height);
        canvas.toBlob((blob) => { save(name, blob); done(blob.size); });
      };
      image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(writeSvg(svg))}`;
    });
  }
  const writeCsv = (rows) => rows.map((row) => row.map((cell) => /[",\n]/.test(cell) ? `"${String(cell).replaceAll('"', '""')}"` : cell).join(",")).join("\n") + "\n";
  // Buttons that save a figure: `find` returns its svg, `list` the rows of its CSV, with a header.
  function addTools(parent, name, find, list) {
    const button = (text, act) => {
      const made = Tables.make("button", { type: "button", ariaLabel: `${text} of ${name}` }, text);
      made.addEventListener("click", act);
      return made;
    };
    const stem = () => `${document.querySelector("h1").textContent.replace(/[^\w-]+/g, "_").slice(0, 40)}-${name}`;
    const buttons = find ? [
      button("PNG", () => savePng(find(), `${stem()}.png`)), button("SVG", () => save(`${stem()}.svg`, writeSvg(find()), "image/svg+xml")),
    ] : [];
    parent.append(Tables.make("span", { className: "tools" }, ...buttons, button("CSV", () => save(`${stem()}.csv`, writeCsv(list()), "text/csv"))));
  }

  return { ROW, forgetWidths, element, clear, vectorAt, savePng, tracePath, largestOf, drawBars, drawPath, drawCurves, drawStar, addTools, writeSvg, writeCsv };
})();
