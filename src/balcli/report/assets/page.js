"use strict";
// The page: shows a document of figures with the devices of the chosen step, in motion. Nothing here computes an engine:
// `Page.show` gets figures from Python, or from the kernel after a change.
const Page = (() => {
  const byId = (id) => document.getElementById(id);
  const read = (id) => byId(id) && JSON.parse(byId(id).textContent);
  const { make, number, fit, sizeText, smallText, kindsOf, scaleOf, KEYS, UNIT_OF, units, limits, BALANCED } = Tables;
  const settings = read("page"), ofFile = read("figures");
  const DEGREES_PER_SECOND = 60, RARE = 125;                  // ms between changes of texts while a slider moves
  const TITLE = { force: "Free force", moment: "Free moment" };
  const LARGE = 0.05, FACTOR = 5;                             // shares of force and moment that are shown side by side
  let { look, file } = settings, compared = false;
  let figures = ofFile, scene = read("scene"), changed = false, chosen = null, turnDrawing = null, theta = 0, asked = null;

  // ------------------------------------------------------------------ steps
  const labelOf = (step, k) => k < figures.ladder.steps.length ? `${k} ${step.step}` : step.step;
  const listChoices = () => [...figures.ladder.steps, ...figures.page.extra];
  const valueOf = (k) => k < figures.ladder.steps.length ? String(k) : figures.page.extra[k - figures.ladder.steps.length].step.split(/[ :]/)[0];
  // The choice with the steps that are fitted by default, or with the scheme of the page.
  function findUsual() {
    const { steps, auto } = figures.ladder, { extra } = figures.page;
    const scheme = extra.findIndex(({ step }) => step.startsWith("scheme ")), other = extra.findIndex(({ step }) => step.startsWith("default"));
    if (scheme >= 0) return steps.length + scheme;
    if (other >= 0) return steps.length + other;
    return Math.max(0, steps.findIndex(({ step }) => step === auto.at(-1)));
  }
  function findChosen() {
    const choices = listChoices(), wanted = choices.findIndex((_, k) => valueOf(k) === asked);
    return wanted >= 0 ? wanted : findUsual();
  }
  // Names of choices that hold only for the engine of the file: a scheme is not computed by the page.
  const listStale = () => changed ? ofFile.page.extra.map(({ step }) => step).filter((step) => step.startsWith("scheme ")) : [];
  const tellSteps = () => `step: this engine has steps 0 to ${figures.ladder.steps.length - 1}`;
  // How a choice is called in a sentence.
  const nameChoice = (k) => k < figures.ladder.steps.length ? `step ${k}` : listChoices()[k].step.replace("default: ", "");

  function showChoices() {
    const labels = listChoices().map(labelOf), stale = listStale(), field = byId("steps"), key = [...labels, "", ...stale].join();
    if (field.dataset.labels !== key) {
      field.dataset.labels = key;
      const chips = labels.map((label, k) => {
        const input = make("input", { type: "radio", name: "step", value: valueOf(k) });
        input.addEventListener("change", () => choose(input.value));
        return make("label", { className: "chip" }, input, label);
      });
      const old = stale.map((label) => make("label", { className: "chip stale", title: "of the file without your changes" },
        make("input", { type: "radio", name: "step", value: "scheme", disabled: true }), label));
      field.replaceChildren(field.querySelector("legend"), ...chips, ...old);
      field.scrollLeft = chips[chosen].offsetLeft - field.offsetLeft - 12;   // on a phone
    }
    field.querySelectorAll("input").forEach((input, k) => {
      input.checked = k === chosen;
      input.parentElement.classList.toggle("on", input.checked);
    });
  }
  // On a page without sliders, the step is all of its address.
  function followAddress() {
    asked = location.hash.match(/[#&]step=([^&]*)/)?.[1] ?? null;
    const wrong = asked !== null && !listChoices().some((_, k) => valueOf(k) === asked);
    if (wrong) asked = null;
    byId("live-wrong").textContent = wrong ? tellSteps() : "";
    show(figures, { scene, changed: false, atOnce: true });
  }
  function writeStep({ detail }) {
    try { history.replaceState(null, "", `#step=${detail}`); } catch { /* a frame of a notebook */ }
  }
  function choose(value) {
    asked = value;
    document.dispatchEvent(new CustomEvent("step", { detail: value }));
    show(figures, { scene, changed, facts: null });
  }

  // ------------------------------------------------------------------ vectors
  const rotate = ([x, y]) => {                                // to the axes of the drawing
    const a = -(look.up || 0) * Math.PI / 180;
    return [x * Math.cos(a) - y * Math.sin(a), x * Math.sin(a) + y * Math.cos(a)];
  };
  // Orders of a force or moment as rows of [order, forward, backward], with the devices of a step.
  function listRows(document, kind, step) {
    const rows = new Map(document.orders.map(({ order, [KEYS[kind]]: v }) => [order, v ? [v.forward, v.backward] : [[0, 0], [0, 0]]]));
    for (const change of step.changes) rows.set(change.order, change[kind]);
    return [...rows].map(([order, parts]) => [order, ...parts.map(rotate)]);
  }
  const sizesOf = (rows, order) => (rows.find(([n]) => n === order) || [order, [0, 0], [0, 0]]).slice(1).map(([x, y]) => Math.hypot(x, y));
  const peakOf = (step, kind) => step[`peak_${KEYS[kind]}`];
  // Force or moment, or both: what is larger beside one cylinder's first order.
  function rankKinds() {
    const [drawn] = ofImportance.ladder.steps, share = (kind) => peakOf(drawn, kind) / (scaleOf(ofImportance, kind) || 1);
    const kinds = kindsOf(ofImportance).sort((a, b) => share(b) - share(a)), [first, second] = kinds.map(share);
    const both = second >= LARGE && first < FACTOR * second;
    return { main: both ? kinds : kinds.slice(0, 1), other: both ? [] : kinds.slice(1) };
  }
  let ofImportance = ofFile;                                  // places on the page do not change while a slider moves

  // ------------------------------------------------------------------ key figures
  const isSmall = (document, kind, value) => value < limits.negligible * scaleOf(document, kind);
  function columnUnit(document, kind) {
    return fit(UNIT_OF[kind], Math.max(...document.ladder.steps.map((step) => peakOf(step, kind))));
  }
  const tellSize = (document, kind, value, unit) => isSmall(document, kind, value) ? smallText(value, UNIT_OF[kind]) : number(value / unit.size);
  function tellChange(document, kind, step) {
    const unit = columnUnit(document, kind), [drawn] = document.ladder.steps, [before, after] = [drawn, step].map((each) => peakOf(each, kind));
    const bare = (value) => isSmall(document, kind, value) ? value ? "<0.1 %" : BALANCED : number(value / unit.size);
    if (isSmall(document, kind, before)) return { texts: [tellSize(document, kind, before, unit)], unit: "" };
    return { texts: step === drawn ? [bare(before)] : [bare(before), bare(after)], unit: unit.name };
  }
  function writeChange({ texts, unit }) {
    const [before, after] = texts, parts = [make("span", { className: "before-text" }, before)];
    if (after !== undefined) parts.push(make("span", { className: "to" }, " → "), make("span", { className: "now-text" }, after));
    return [...parts, make("small", {}, unit && ` ${unit}`)];
  }
  function tellDevices(step) {
    const count = (n, name) => n ? `${n} ${name}${n > 1 ? "s" : ""}` : "";
    const mass = step.steel_kg ? `${number(step.steel_kg / units.mass.size, 3)} ${units.mass.name} of steel` : "";
    return [count(step.counterweights, "counterweight"), count(step.shafts, "shaft"), mass].filter(Boolean).join(", ");
  }
  function showKey() {
    const { main, other } = rankKinds(), step = listChoices()[chosen], drawn = chosen === 0, before = ofImportance.ladder.steps;
    const told = tellDevices(step), row = before.find((each) => each.step === step.step) || before[0];
    const large = main.map((kind) => make("div", {},
      make("h2", {}, TITLE[kind]), make("p", { className: "big" }, ...writeChange(tellChange(figures, kind, step)))));
    const was = compared ? main.map((kind) => { const { texts, unit } = tellChange(ofImportance, kind, row); return `${texts.join(" → ")} ${unit}`; }).join("; ") : "";
    const line = drawn ? "as drawn" : `as drawn → with ${nameChoice(chosen)}${told && `: ${told}`}`;
    const small = other.map((kind) => [TITLE[kind], writeChange(tellChange(figures, kind, step))]);
    if (kindsOf(figures).length < 2) small.push(["Free moment", ["not known"]]);
    if (step.main_bearing_N !== undefined) small.push(["Main bearing", writeChange(tellLoad(step, drawn))]);
    small.push([look.gas ? "Roll, inertia" : "Roll moment", tellRoll()]);
    byId("key-large").replaceChildren(...large);
    byId("key-with").textContent = line;
    byId("key-was").textContent = was && `${file || "file"}: ${was}`;
    byId("key-small").replaceChildren(...small.map(([name, parts]) => make("div", {}, make("h2", {}, name), make("p", {}, ...parts))));
  }
  function tellLoad(step, drawn) {
    const loads = [figures.ladder.steps[0], step].map((each) => each.main_bearing_N), unit = fit(units.force, Math.max(...figures.ladder.steps.map((each) => each.main_bearing_N || 0)));
    const texts = loads.map((load) => load > 1e-12 * scaleOf(figures, "force") ? number(load / unit.size) : BALANCED);
    return { texts: drawn ? texts.slice(0, 1) : texts, unit: unit.name };
  }
  function tellRoll() {
    const largest = figures.orders.filter(({ order }) => order > 0).reduce((a, b) => b.roll_Nm.amplitude > a.roll_Nm.amplitude ? b : a);
    const { amplitude } = largest.roll_Nm;
    if (amplitude <= limits.negligible * figures.page.scales.roll_Nm) return [smallText(amplitude, units.moment)];
    return [`${sizeText(amplitude, units.moment)} `, make("small", {}, `order ${largest.order}`)];
  }

  // ------------------------------------------------------------------ bars and paths
  const find = (id, kind) => byId(`${id}-${kind}`);
  function prepareCharts() {
    const { main } = rankKinds();
    if (byId("bars").dataset.kinds === main.join()) return;
    byId("bars").dataset.kinds = main.join();
    byId("hero").classList.toggle("both", main.length > 1);
    for (const [id, title] of [["bars", "by order"], ["path", "over a revolution"], ["turn", "over a revolution"]]) {
      byId(`${id}-charts`).replaceChildren(...main.map((kind) => {
        const svg = Charts.element("svg", { id: `${id}-${kind}`, role: "img" }), caption = make("figcaption", {});
        svg.dataset.title = `${id === "path" ? "Path of the " : "Size of the "}${TITLE[kind].toLowerCase()}`;
        caption.append(make("span", { id: `${id}-${kind}-title` }, id === "path" ? `Path of the ${kind}` : `${TITLE[kind]} ${title}`));
        Charts.addTools(caption, `${id}-${kind}`, () => find(id, kind), () => ({ bars: listBarRows, path: listPathRows, turn: listTurnRows })[id](kind));
        return make("figure", {}, caption, svg);
      }));
    }
  }
  const room = { engine: null, rows: 0 };
  // Keeps the room of the most rows that the bars of an engine had, so that rows that go move nothing below them.
  function keepRoom() {
    const rows = Math.max(...rankKinds().main.map((kind) => listBars(kind).length), room.engine === ofImportance ? room.rows : 0);
    if (room.engine === ofImportance && room.rows === rows) return;
    Object.assign(room, { engine: ofImportance, rows });
    byId("bars-charts").style.minHeight = rows > 4 ? `calc(${Charts.ROW * rows}px + 1.9rem)` : "";
  }
  const rowsNow = (kind) => listRows(figures, kind, listChoices()[chosen]), rowsDrawn = (kind) => listRows(figures, kind, figures.ladder.steps[0]);
  function listBars(kind) {
    const matter = figures.orders.filter(({ order, [KEYS[kind]]: v }) => order >= 1 && v.major > limits.negligible * scaleOf(figures, kind));
    const last = Math.max(2, ...matter.map(({ order }) => order)), [before, after] = [rowsDrawn(kind), rowsNow(kind)];
    return Array.from({ length: last }, (_, k) => ({ order: k + 1, before: sizesOf(before, k + 1), after: chosen ? sizesOf(after, k + 1) : null }));
  }
  const total = (parts) => parts[0] + parts[1];
  function drawBars(kind) {
    const bars = listBars(kind), largest = Math.max(...bars.map(({ before, after }) => Math.max(total(before), after ? total(after) : 0))), unit = fit(UNIT_OF[kind], largest);
    const rounding = 1e-11 * scaleOf(figures, kind), write = (parts) => total(parts) > rounding ? number(total(parts) / unit.size) : BALANCED;
    find("bars", kind).setAttribute("aria-label", `${TITLE[kind]} by order`);
    find("bars-" + kind, "title").textContent = `${TITLE[kind]} by order, ${unit.name}`;
    Charts.drawBars(find("bars", kind), bars.map((bar) => {
      const balanced = total(bar.before) <= rounding, told = [write(bar.before), ...bar.after && !(balanced && total(bar.after) <= rounding) ? [write(bar.after)] : []];
      return { ...bar, before: balanced ? null : bar.before, after: balanced && told.length < 2 ? null : bar.after, told, cure: balanced ? "" : tellCure(kind, bar, unit) };
    }), largest);
  }
  // What cancels the parts of an order: "counterweights 2270, shaft at -1 464.4".
  function tellCure(kind, { order, before }, unit) {
    const finding = figures.verdict.matter.find((each) => each.order === order);
    if (!finding || !finding.large.includes(kind)) return "small: left";
    if (order > 2 || !finding.cures?.length || finding.cures.some((cure) => cure.takes_back)) return Tables.tellCures(figures, order);
    return finding.cures.map((cure) => `${Tables.nameCure(cure)} ${number(before[cure.ratio > 0 ? 0 : 1] / unit.size)}`).join(", ");
  }
  function drawPath(kind) {
    const step = listChoices()[chosen], now = rowsNow(kind), paths = { before: Charts.tracePath(rowsDrawn(kind)) };
    if (chosen) paths.now = Charts.tracePath(now);
    const { steps } = ofImportance.ladder;
    if (compared) paths.file = Charts.tracePath(listRows(ofImportance, kind, steps.find((each) => each.step === step.step) || steps[0]));
    const { texts } = tellChange(figures, kind, step);
    const { place, put } = Charts.drawPath(find("path", kind), paths, { names: look.names[kind], labels: { before: texts[0], now: texts[1] }, theta, rows: now });
    find("path", kind).setAttribute("aria-label", `Path of the ${TITLE[kind].toLowerCase()} over a revolution`);
    if (byId("chain").checked) drawChain(now, place, put);
  }
  // The two turning vectors of each order, one after the other.
  function drawChain(rows, place, put) {
    let at = [0, 0];
    for (const [n, forward, backward] of rows) {
      for (const [kind, vector] of [["ahead", Charts.vectorAt([[n, forward, [0, 0]]], theta)], ["behind", Charts.vectorAt([[n, [0, 0], backward]], theta)]]) {
        const next = [at[0] + vector[0], at[1] + vector[1]], [from, to] = [place(at), place(next)];
        put("path", { class: `chain ${kind}`, d: `M${from}L${to}` });
        at = next;
      }
    }
  }

  // ------------------------------------------------------------------ lower charts
  const DEGREES = Array.from({ length: 361 }, (_, k) => k);
  const sizeOverTurn = (rows) => DEGREES.map((degree) => Math.hypot(...Charts.vectorAt(rows, degree * Math.PI / 180)));
  function listTurnLines(kind) {
    const lines = [{ name: "as drawn", kind: "before", values: sizeOverTurn(rowsDrawn(kind)) }];
    if (chosen) lines.push({ name: `with ${nameChoice(chosen)}`, kind: "now", values: sizeOverTurn(rowsNow(kind)) });
    return lines;
  }
  function drawTurn(kind) {
    const lines = listTurnLines(kind), unit = fit(UNIT_OF[kind], Math.max(...lines.flatMap(({ values }) => values)));
    Charts.drawCurves(find("turn", kind), { end: 360, unit: unit.name, lines: lines.map((line) => ({ ...line, values: line.values.map((v) => v / unit.size) })) });
  }
  const ABOUT = [["couple C", "couple", "couple_Nm"], ["inertia torque T", "torque", "inertia_torque_Nm"], ["roll C − T", "sum", "roll_Nm"]];
  function listAboutLines() {
    return ABOUT.map(([name, kind, key]) => ({
      name, kind, values: DEGREES.map((degree) => figures.orders.reduce((sum, { order, [key]: v }) => {
        const angle = order * degree * Math.PI / 180;
        return sum + v.cos * Math.cos(angle) + v.sin * Math.sin(angle);
      }, 0)),
    }));
  }
  function drawAbout() {
    const lines = listAboutLines(), unit = fit(units.moment, Math.max(...lines.flatMap(({ values }) => values.map(Math.abs))));
    Charts.drawCurves(byId("about-curve"), { end: 360, unit: unit.name, lines: lines.map((line) => ({ ...line, values: line.values.map((v) => v / unit.size) })) });
  }
  const toVector = (size, degrees) => rotate([size * Math.cos(degrees * Math.PI / 180), size * Math.sin(degrees * Math.PI / 180)]);
  function drawStars() {
    byId("stars-charts").replaceChildren(...figures.stars.map(({ order, turns, banks }) => {
      const rays = banks.flatMap(({ cylinders }, bank) => cylinders.filter((ray) => ray.force_N).map((ray) =>
        ({ vector: toVector(ray.force_N, ray.force_deg), label: ray.cylinder, bank })));
      const svg = Charts.element("svg", { role: "img", "aria-label": `Star of order ${order}, ${turns}` });
      Charts.drawStar(svg, rays);
      return make("figure", {}, svg, make("figcaption", {}, `order ${order}, ${turns === "forward" ? "with the crank" : "against it"}`));
    }));
  }
  function drawLadderPaths() {
    const [kind] = rankKinds().main;
    byId("ladder-paths").replaceChildren(...figures.ladder.steps.map((step, k) => {
      const svg = Charts.element("svg", { role: "img", "aria-label": `Path of the ${kind} with step ${k}, to its own scale` });
      Charts.drawPath(svg, { [k ? "now" : "before"]: Charts.tracePath(listRows(figures, kind, step)) }, { names: look.names[kind], wide: 90 });
      const value = peakOf(step, kind), unit = columnUnit(figures, kind);
      return make("figure", {}, svg, make("figcaption", {}, `${k}: ${tellSize(figures, kind, value, unit)} ${isSmall(figures, kind, value) ? "" : unit.name}`));
    }));
  }

  // ------------------------------------------------------------------ data of charts as CSV
  const SI = { force: "N", moment: "N m" }, columnsOf = (kind) => `${kind}, ${SI[kind]}`;
  function listBarRows(kind) {
    const head = ["order", "as drawn with crank", "as drawn against", "now with crank", "now against"];
    return [head.map((text, k) => k ? `${text}, ${columnsOf(kind)}` : text), ...listBars(kind).map(({ order, before, after }) => [order, ...before, ...(after || before)])];
  }
  function listPathRows(kind) {
    const [before, now] = [rowsDrawn(kind), rowsNow(kind)], [up, right] = look.names[kind];
    const head = ["crank angle, deg", ...["as drawn", "now"].flatMap((state) => [up, right].map((name) => `${state}: ${name}, ${columnsOf(kind)}`))];
    return [head, ...DEGREES.map((degree) => [degree, ...[before, now].flatMap((rows) => Charts.vectorAt(rows, degree * Math.PI / 180))])];
  }
  function listTurnRows(kind) {
    const lines = listTurnLines(kind);
    return [["crank angle, deg", ...lines.map(({ name }) => `${name}, ${columnsOf(kind)}`)], ...DEGREES.map((degree) => [degree, ...lines.map(({ values }) => values[degree])])];
  }
  const listTable = (id) => [...byId(id).rows].map((row) => [...row.cells].map((cell) => cell.textContent));

  // ------------------------------------------------------------------ tables
  function showTables({ facts }) {
    if (facts) Tables.fillFacts(byId("facts"), facts);
    if (changed || showTables.written) {
      showTables.written = true;
      const about = Tables.makeAbout(figures);
      const title = byId("ladder").querySelector("h2").firstChild;
      title.data = title.data.replace(/\(.* rpm\)/, `(${number(figures.speed_rpm, 6)} rpm)`);
      Tables.fill(byId("ladder-table"), Tables.makeLadder(figures));
      Tables.fill(byId("about-table"), about);
      byId("about").querySelector("h2 small").textContent = about.unit;
      byId("about").classList.toggle("nothing", !about.rows.length);
      Tables.fillFacts(byId("largest-list"), Tables.listLargest(figures, look.gas));
    }
    Tables.fill(byId("orders-table"), Tables.addCures(figures, Tables.makeOrders(figures)));
    Tables.fill(byId("devices-table"), Tables.makeDevices(listChoices()[chosen]));
    byId("devices-title").textContent = chosen ? `Devices of ${nameChoice(chosen)}` : "Devices: choose a step above";
    byId("devices-table").hidden = !chosen;
    [...byId("ladder-table").tBodies[0].rows].forEach((row, k) => row.classList.toggle("sel", k === chosen));
  }

  // ------------------------------------------------------------------ show
  let last = 0, later = null;
  // Shows figures and the engine of a scene; `facts` are pairs for the head, null if they stay.
  // `engine` has the figures of its file, and `shown` how to draw it and the name of the file.
  function show(next, { scene: mechanism, changed: differs, compared: against = compared, facts = null, engine = ofImportance, shown = { look, file }, atOnce = false }) {
    compared = against;
    ({ look, file } = shown);
    const steps = listChoices().length;
    [figures, scene, changed, ofImportance] = [next, mechanism, differs, engine];
    chosen = findChosen();
    if (steps) prepareCharts();
    if (parked) park();
    showChoices();
    showKey();
    drawCharts();
    drawScene();
    clearTimeout(later);
    const now = performance.now();
    if (atOnce || now - last >= RARE) showRest({ facts });
    else later = setTimeout(() => showRest({ facts }), RARE - (now - last));
  }
  function showRest({ facts }) {
    last = performance.now();
    showTables({ facts });
    const { main } = rankKinds();
    main.forEach(drawTurn);
    drawAbout();
    drawLadderPaths();
    drawStars();
    document.dispatchEvent(new CustomEvent("shown"));
  }
  function drawCharts() {
    for (const kind of rankKinds().main) { drawBars(kind); drawPath(kind); }
    keepRoom();
  }
  function drawScene() {
    if (!scene) return;
    const devices = [...figures.page.devices, ...listChoices()[chosen].devices].map((d) => ({
      ...d, at: rotate(d.at_mm), z: d.position_mm, forward: rotate(d.forward).map((v) => 1e6 * v), backward: rotate(d.backward).map((v) => 1e6 * v),
    }));
    turnDrawing = Mechanism.draw(scene, devices, look.axes);
    turn();
  }
  function turn() {
    theta = Number(byId("angle").value) * Math.PI / 180;
    byId("angle-now").textContent = `${Math.round(Number(byId("angle").value))}°`;
    const [kind] = rankKinds().main, rows = rowsNow(kind), most = peakOf(listChoices()[chosen], kind);
    if (turnDrawing) turnDrawing(Number(byId("angle").value), { kind, vector: Charts.vectorAt(rows, theta), largest: isSmall(figures, kind, most) ? 0 : most });
    rankKinds().main.forEach(drawPath);
    document.dispatchEvent(new CustomEvent("crank", { detail: Number(byId("angle").value) }));
  }

  // ------------------------------------------------------------------ start
  function startMotion() {
    const angle = byId("angle"), play = byId("play"), hero = byId("hero");
    const advance = (degrees) => {
      angle.step = "any";
      angle.value = (Number(angle.value) + degrees) % Number(angle.max);
      if (hero.getBoundingClientRect().bottom > 0) turn();    // not while nobody sees it
    };
    const stop = () => { angle.step = "1"; angle.value = Math.round(Number(angle.value)); turn(); };
    play.addEventListener("click", () => { parked = false; });
    Motion.attach(play, DEGREES_PER_SECOND, advance, stop);
    angle.addEventListener("input", turn);
    byId("chain").addEventListener("change", turn);
    angle.addEventListener("input", () => { parked = false; });
    const isStill = parked;
    park();
    if (!isStill) play.click();
  }
  // The angle of the largest value, where the drawing stands if the reader wants no motion.
  let parked = matchMedia("(prefers-reduced-motion: reduce)").matches;
  function park() {
    byId("angle").value = Math.round(figures.peak[`${rankKinds().main[0]}_deg`] || 0);
  }
  function startTheme() {
    const theme = byId("theme"), root = document.documentElement;
    theme.hidden = false;
    theme.addEventListener("click", () => {
      const set = root.dataset.theme, dark = set ? set === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
      root.dataset.theme = dark ? "light" : "dark";
    });
  }
  // Curves of the file: torque and pressure of gas, motion of a piston.
  function drawFileCurves() {
    const running = read("running"), motion = read("motion");
    const lineOf = (curve) => [
      { name: curve.gas ? "total" : curve.crank_end ? "head end" : curve.title || "pressure", kind: curve.gas ? "sum" : "now", values: curve.total },
      ...curve.gas ? [{ name: "gas", kind: "gas", values: curve.gas }, { name: "mean", kind: "before", values: curve.gas.map(() => curve.mean) }] : [],
      ...curve.crank_end ? [{ name: "crank end", kind: "gas", values: curve.crank_end }] : [],
    ];
    for (const [data, end] of [[running, running?.cycle], [motion, 360]]) {
      for (const curve of data?.curves || []) Charts.drawCurves(byId(`${curve.id}-curve`), { end, unit: curve.unit, lines: lineOf(curve) });
    }
  }
  // Pictures of torsion, which Python drew: SVG texts, packed.
  async function showTorsion() {
    const packed = byId("torsion-packed");
    if (!packed) return;
    for (const svg of JSON.parse(await Packed.unpack(packed.textContent))) {
      const figure = make("figure", { tabIndex: 0 });         // it scrolls on a phone
      figure.innerHTML = svg;
      byId("torsion-pictures").append(figure);
    }
  }
  function start() {
    Charts.addTools(byId("orders").querySelector("h2"), "orders", null, () => listTable("orders-table"));
    Charts.addTools(byId("ladder").querySelector("h2"), "ladder", null, () => listTable("ladder-table"));
    prepareCharts();
    startMotion();
    startTheme();
    drawFileCurves();
    showTorsion();
    show(ofFile, { scene, changed: false });
    if (!byId("live")) {
      followAddress();
      addEventListener("hashchange", followAddress);
      document.addEventListener("step", writeStep);
    }
    let wide = innerWidth;
    addEventListener("resize", () => {
      if (innerWidth === wide) return;
      wide = innerWidth;
      Charts.forgetWidths();
      drawCharts();
    });
  }
  return { show, start, choose, turn, ofFile, get chosen() { return chosen; }, tellSteps,
    get steps() { return [...listChoices().map((_, k) => valueOf(k)), ...listStale().map(() => "scheme")]; }, set asked(value) { asked = value; } };
})();
Page.start();
