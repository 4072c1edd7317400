"use strict";
// The panel "Change the engine": numbers to drag, the state in the address, and files to take away.
(() => {
  const byId = (id) => document.getElementById(id);
  const book = JSON.parse(byId("live").textContent);          // engines by name, and units
  const TITLES = { crank: "Crank", rod: "Rods", piston: "Pistons", layout: "Layout", operation: "Speed" };
  const FIELDS = {
    counterweight: { unbalance: "g mm", angle: "deg", position: "mm" },
    shaft: { ratio: "", unbalance: "g mm", angle: "deg", "at.1": "mm", "at.2": "mm", position: "mm" },
  };
  let data, original, numbers, engine, ladder, before, past = [], future = [];

  const make = (tag, attributes = {}, ...children) => {
    const made = document.createElement(tag);
    Object.assign(made, attributes);
    made.append(...children);
    return made;
  };
  const button = (text, act) => {
    const made = make("button", { type: "button" }, text);
    made.addEventListener("click", act);
    return made;
  };
  const tableOf = (name) => name.match(/^(?:counterweight|shaft|slider|cylinder)\.\d+/)?.[0] ?? name.split(".")[0];
  const isDevice = (name) => /^(counterweight|shaft|slider)\./.test(name);
  const unitOf = (name) => {
    const known = data.numbers.find((each) => each.name === name);
    if (known) return known.unit;
    const [, kind, key] = name.match(/^(\w+)\.\d+\.(.+)$/) || [];
    return FIELDS[kind]?.[key];
  };
  const short = (value) => String(Number(value.toPrecision(12)));
  const shown = (value, digits = 4) => {
    const text = value.toPrecision(digits);
    return Math.abs(value) >= 1000 ? Number(text).toFixed(0) : String(Number(text));
  };

  // ------------------------------------------------------------------ values as people write them
  // A number in the unit of the file; an Error says what would be right.
  function readValue(name, text) {
    const unit = unitOf(name), plain = text.trim().replace(/^[-−]/, "-").replace(",", ".");
    const match = plain.match(/^(-?)(?:(\d+)\s+)?(\d+)\/(\d+)\s*(.*)$/);
    const figure = plain.match(/^(-?\d*\.?\d+(?:e[-+]?\d+)?)\s*(.*)$/i);
    const wanted = `give a number${unit ? ` in ${unit}` : ""}`;
    if (!match && !figure) throw new Error(`${name}: "${text.slice(0, 40)}" is no number; ${wanted}`);
    const value = match ? (match[1] ? -1 : 1) * (Number(match[2] || 0) + match[3] / match[4]) : Number(figure[1]);
    const own = (match ? match[5] : figure[2]).trim();
    const factor = own === "" || own === unit ? 1 : book.units[unit]?.[own];
    if (factor === undefined) {
      const known = Object.keys(book.units[unit] || {}).join(", ");
      throw new Error(`${name}: the unit "${own.slice(0, 20)}" is not known here; ${wanted}${known && `, or in ${known}`}`);
    }
    if (!Number.isFinite(value)) throw new Error(`${name}: is no finite number; ${wanted}`);
    return value * factor;
  }

  function rangeOf(name, value) {
    const unit = unitOf(name);
    if (name === "layout.bank_angle") return [0, 180];
    if (unit === "deg") return value < 0 || value > 360 ? [-360, 360] : [0, 360];
    if (/\.(at\.[12]|position|offset|positions\.\d+|piston_offset)$|stagger$/.test(name)) {
      const far = Math.max(2 * Math.abs(value), /offset|stagger/.test(name) ? 50 : 4 * (numbers["crank.stroke"] || 100));
      return [-far, far];
    }
    if (!value) return [0, { mm: 100, kg: 5, "g mm": 100000 }[unit] || 1];
    return [value / 2, 2 * value];
  }

  // ------------------------------------------------------------------ state and address
  function changes() {
    const found = Object.entries(numbers).filter(([name, value]) => value !== original[name]);
    const gone = Object.keys(original).filter((name) => !(name in numbers)).map(tableOf);
    return [...found.map(([name, value]) => [name, short(value)]), ...[...new Set(gone)].map((table) => [table, "none"])];
  }
  function writeAddress() {
    const parts = changes().map(([name, value]) => `${name}=${encodeURIComponent(value)}`);
    if (book.choice) parts.unshift(`engine=${data.key}`);
    try {
      history.replaceState(null, "", parts.length ? `#${parts.join("&")}` : location.pathname + location.search);
    } catch { /* a frame of a notebook has no address */ }
  }
  // Numbers of the address; what it says wrongly is told, the rest applies.
  function readAddress() {
    const wrong = [], next = { ...original };
    const parts = location.hash.slice(1).split("&").filter(Boolean).map((part) => {
      const [name, ...value] = part.split("=");
      try { return [name, decodeURIComponent(value.join("="))]; } catch { return [name, value.join("=")]; }
    });
    for (const [name, value] of parts) {
      if (name === "engine" && book.choice) continue;
      if (value === "none" && isDevice(name)) remove(next, name);
      else if (unitOf(name) === undefined) wrong.push(`${name.slice(0, 60)}: there is no such number`);
      else try { next[name] = readValue(name, value); } catch (error) { wrong.push(error.message); }
    }
    return { next, wrong };
  }
  function remove(from, table) {
    for (const name of Object.keys(from)) if (tableOf(name) === table) delete from[name];
  }

  // ------------------------------------------------------------------ change, undo, redo
  // Shows these numbers if they make an engine; the last good one stays otherwise.
  function apply(next, { remember = true, wrong = [], rebuild = false } = {}) {
    let found;
    try {
      const made = Kernel.assemble(data, next);
      found = { made, ladder: Kernel.findLadder(made) };
    } catch (error) {
      tell([error.message, ...wrong]);
      return false;
    }
    const tables = (state) => [...new Set(Object.keys(state).map(tableOf))].join();
    rebuild ||= tables(next) !== tables(numbers);
    if (remember) { past.push(numbers); future = []; }
    numbers = next;
    [engine, ladder] = [found.made, found.ladder];
    writeAddress();
    tell(wrong);
    if (rebuild) buildControls();
    show();
    return true;
  }
  const change = (name, value, how) => apply({ ...numbers, [name]: value }, how);
  function step(from, to) {
    if (!from.length) return;
    to.push(numbers);
    apply(from.pop(), { remember: false, rebuild: true });
  }
  const tell = (messages) => { byId("live-wrong").textContent = messages.join(" · "); };

  // ------------------------------------------------------------------ what the page shows
  let waiting = false;
  function show() {
    const figures = Kernel.describe(engine, ladder), changed = changes().length > 0;
    byId("figures").textContent = JSON.stringify(figures);
    byId("live-still").hidden = !changed;
    byId("live-verdict").textContent = tellVerdict(figures);
    showOrders(figures);
    showLadder(figures);
    for (const input of byId("live-numbers").querySelectorAll("input")) {
      if (input !== document.activeElement || input.type === "range") input.value = short(numbers[input.name] ?? 0);
    }
    if (!waiting) {
      waiting = true;
      requestAnimationFrame(() => { waiting = false; Page.draw(makeScene()); });
    }
  }
  const NAMES = ["Mean", "First", "Second", "Third", "Fourth"];
  function tellVerdict(figures) {
    const { force_N: F, moment_Nm: M } = figures.ladder.scale;
    const told = figures.orders.flatMap(({ order, force_N: f, moment_Nm: m }) => {
      const large = [];
      if (f.major >= 0.05 * F && f.major) large.push(`force of ${shown(f.major)} N`);
      if (M && m.major >= 0.05 * M) large.push(`moment of ${shown(m.major)} N·m`);
      return large.length ? [`${NAMES[order] || `${order}th`} order: ${large.join(" and ")}.`] : [];
    });
    return told.join(" ") || "No order is large compared with one cylinder.";
  }
  function fill(id, heads, rows) {
    const cells = (tag, row) => make("tr", {}, ...row.map((cell) => make(tag, {}, cell)));
    byId(id).replaceChildren(make("thead", {}, cells("th", heads)), make("tbody", {}, ...rows.map((row) => cells("td", row))));
  }
  function showOrders(figures) {
    const least = { N: 1e-6 * figures.ladder.scale.force_N, m: 1e-6 * (figures.ladder.scale.moment_Nm || 0) };
    const size = (value, small) => value <= small ? "balanced" : shown(value);
    const seen = figures.orders.filter(({ order, force_N: f, moment_Nm: m, roll_Nm: roll }) =>
      order === 1 || order === 2 || [f.major > least.N, m.major > least.m, roll.amplitude > least.m].some(Boolean));
    const rows = seen.map(({ order, force_N: f, moment_Nm: m, roll_Nm: roll }) => [
      String(order), size(f.major, least.N), ...[f.forward, f.backward].map((v) => size(Math.hypot(...v), least.N)),
      ...(data.known ? [m.major, ...[m.forward, m.backward].map((v) => Math.hypot(...v))].map((v) => size(v, least.m)) : ["–", "–", "–"]),
      size(roll.amplitude, least.m),
    ]);
    const peak = figures.peak;
    rows.push(["all", shown(peak.force_N), "", "", data.known ? shown(peak.moment_Nm) : "–", "", "", ""]);
    fill("live-orders", ["order", "force, N", "with crank", "against", "moment, N·m", "with crank", "against", "roll, N·m"], rows);
  }
  function showLadder(figures) {
    const rows = figures.ladder.steps.map((one, k) => [
      `${k} ${one.step}`, shown(one.peak_force_N), data.known ? shown(one.peak_moment_Nm) : "–", String(one.counterweights || "–"),
      String(one.shafts || "–"), one.mass_kg ? shown(one.mass_kg, 3) : "–", k ? button("Fit", () => fit(k)) : "",
    ]);
    fill("live-ladder", ["step", "force, N", "moment, N·m", "weights", "shafts", "kg", ""], rows);
  }
  // Adds the devices of a step of the ladder to the numbers.
  function fit(k) {
    const next = { ...numbers }, degrees = (angle) => (angle * 180 / Math.PI % 360 + 360) % 360;
    for (const d of ladder.steps[k].devices) {
      const table = freeTable(next, d.kind), start = d.kind === "counterweight" ? engine.firstAxis : 0;
      Object.assign(next, { [`${table}.unbalance`]: d.U * 1e6, [`${table}.angle`]: degrees(d.angle - start), [`${table}.position`]: d.z * 1e3 });
      if (d.kind === "shaft") Object.assign(next, { [`${table}.ratio`]: d.ratio, [`${table}.at.1`]: 0, [`${table}.at.2`]: 0 });
    }
    apply(next, { rebuild: true });
  }
  function freeTable(state, kind) {
    let n = 1;
    while (Object.keys(state).some((name) => tableOf(name) === `${kind}.${n}`)) n++;
    return `${kind}.${n}`;
  }

  // ------------------------------------------------------------------ pictures
  const ASSUMED_BORE = 0.95;
  function describeVariant(label, made, found) {
    const turn = Math.PI / 180 * (made.up || 0), [c, s] = [Math.cos(turn), -Math.sin(turn)];
    const turned = ([x, y]) => [x * c - y * s, x * s + y * c];
    const rows = (kind) => found.kinds[kind].slice(0, 13).map(([a, b], n) => [n, ...[...turned(a), ...turned(b)].map((v) => v / book.show[kind].size)]);
    const beside = {};
    return {
      label, force: rows("force"), moment: made.known ? rows("moment") : [],
      devices: made.devices.map((d) => {
        const hidden = d.kind === "shaft" && Math.hypot(...d.at) < made.r, side = d.ratio > 0 ? 1 : -1;
        const level = beside[side] ??= new Map();
        if (hidden && !level.has(d.order)) level.set(d.order, level.size);
        const place = hidden ? [-1.6 * made.r * level.get(d.order), side * (widthOf(made) + made.r)] : turned(d.at);
        return {
          order: d.order, forward: turned(d.forward).map((v) => v * 1e6), backward: turned(d.backward).map((v) => v * 1e6),
          at: place.map((v) => v * 1e3), z: d.z * 1e3, beside: hidden,
        };
      }),
    };
  }
  const boreOf = (made) => made.bore || ASSUMED_BORE * 2 * made.r;
  function widthOf(made) {                                    // of the engine, to one side of the crank axis
    return Math.max(1.5 * made.r, ...made.cylinders.map((c) => {
      const across = Math.abs(Math.sin(c.axis - Math.PI / 180 * (made.up || 0)));
      return across * (c.r + c.l + boreOf(made)) + (1 - across) * boreOf(made);
    }));
  }
  function makeScene() {
    const now = ladder.steps[0].found, old = before.found;
    const deg = (angle) => angle * 180 / Math.PI, changed = changes().length > 0;
    const variants = [describeVariant("before", before.made, old)];
    if (changed) variants.push(describeVariant("now", engine, now));
    const { force: F, moment: M } = ladder.scale;
    const unit = (kind, scale) => ({ ...book.show[kind], least: 1e-3 * (scale || 1) / book.show[kind].size });
    const counts = (n) => [now, old].some(({ kinds }) => ["force", "moment"].some((kind) => kinds[kind][n].some((v) => Math.hypot(...v))));
    return {
      stroke: 2e3 * engine.r, bore: 1e3 * boreOf(engine), rotary: false, axes: data.axes,
      cylinders: engine.cylinders.map((c) => ({
        number: c.number, axis: deg(c.axis) - (engine.up || 0), phase: deg(c.psi), z: 1e3 * c.z, rod: 1e3 * c.l, offset: 1e3 * c.e,
      })),
      variants, shown: variants.length - 1, units: { force: unit("force", F), moment: unit("moment", M) },
      orders: Array.from({ length: 13 }, (_, n) => n).filter(counts),
    };
  }

  // ------------------------------------------------------------------ the panel
  function buildControls() {
    const groups = new Map();
    for (const name of Object.keys(numbers)) groups.set(tableOf(name), [...(groups.get(tableOf(name)) || []), name]);
    const sets = [...groups].map(([table, names]) => {
      const title = TITLES[table] || table.replace(".", " ").replace(/^./, (c) => c.toUpperCase());
      const rows = names.map((name) => control(name, table));
      if (isDevice(table)) rows.push(button(`Remove ${title.toLowerCase()}`, () => removeDevice(table)));
      return make("fieldset", { className: "numbers" }, make("legend", {}, title), ...rows);
    });
    byId("live-numbers").replaceChildren(...sets);
  }
  function control(name, table) {
    const value = numbers[name], [least, most] = rangeOf(name, value), unit = unitOf(name), label = name.slice(table.length + 1);
    const whole = /\.(ratio|order)$/.test(name) && isDevice(name);
    const slider = make("input", { type: "range", name, min: least, max: most, step: "any", value });
    const field = make("input", { type: "text", name, value: short(value), inputMode: "decimal", id: `n-${name}` });
    slider.setAttribute("aria-label", `${name}${unit ? `, ${unit}` : ""}`);
    let started = false;                                      // one undo for one drag
    slider.addEventListener("input", () => {
      if (change(name, Number(Number(slider.value).toPrecision(5)), { remember: !started })) started = true;
    });
    slider.addEventListener("change", () => { started = false; });
    field.addEventListener("change", () => {
      try {
        const wanted = readValue(name, field.value);
        if (whole && (!Number.isInteger(wanted) || !wanted)) throw new Error(`${name}: give a whole number other than 0`);
        if (!change(name, wanted)) field.value = short(numbers[name]);
        else if (wanted < slider.min || wanted > slider.max) [slider.min, slider.max] = rangeOf(name, wanted);
        slider.value = numbers[name];
      } catch (error) { tell([error.message]); field.value = short(numbers[name]); }
    });
    const head = make("label", { htmlFor: field.id }, label.replace(/^throws\./, "throw ").replaceAll("_", " "));
    return make("div", { className: "number" }, head, whole ? "" : slider, field, make("span", {}, unit || ""));
  }
  function removeDevice(table) {
    const next = { ...numbers };
    remove(next, table);
    apply(next, { rebuild: true });
    byId("live-add-weight").focus();
  }
  function addDevice(kind, ratio) {
    const table = freeTable(numbers, kind), next = { ...numbers };
    for (const key of Object.keys(FIELDS[kind])) next[`${table}.${key}`] = key === "ratio" ? ratio : key === "unbalance" ? 10000 : 0;
    apply(next, { rebuild: true });
    byId(`n-${table}.unbalance`)?.focus();
  }

  // ------------------------------------------------------------------ files
  // The text of the file with the numbers of the page; comments stay where a line only changes its number.
  function writeFile() {
    const lines = data.text.replaceAll("\r\n", "\n").split("\n"), added = [];
    const header = /^\s*\[{1,2}\s*([\w.-]+)\s*\]{1,2}/, lists = {};
    const sections = [];                                      // name of the table of each line, and where it begins
    lines.forEach((line, k) => {
      const name = line.match(header)?.[1];
      if (name) sections.push({ name: line.includes("[[") ? `${name}.${lists[name] = (lists[name] || 0) + 1}` : name, from: k });
    });
    const sectionOf = (table) => {
      const at = sections.findIndex(({ name }) => name === table);
      return at < 0 ? null : { from: sections[at].from, to: sections[at + 1]?.from ?? lines.length };
    };
    const values = Object.fromEntries(changes()), fresh = {};
    for (const [name, value] of Object.entries(values)) {
      const table = tableOf(name), key = name.slice(table.length + 1), found = sectionOf(table);
      if (value === "none") {
        if (found) for (let k = found.from; k < found.to; k++) lines[k] = null;
        continue;
      }
      if (!found) { (fresh[table] ??= {})[key] = value; continue; }
      const [, outer, member] = key.match(/^(\w+)(?:\.(\d+))?$/), start = new RegExp(`^(\\s*${outer}\\s*=\\s*)`);
      const row = lines.findIndex((line, k) => k > found.from && k < found.to && line !== null && start.test(line));
      if (row < 0) {
        added.push({ after: found.from, text: `${outer} = ${member ? listOf(table, outer) : value}` });
      } else if (member) {
        let k = 0;
        lines[row] = lines[row].replace(/\[.*\]/, (list) => list.replace(/"[^"]*"|[^\s,[\]]+/g, (item) => ++k === Number(member) ? value : item));
      } else {
        lines[row] = lines[row].replace(start, "$1\u0000").replace(/\u0000("[^"]*"|'[^']*'|[^\s#]+)/, value);
      }
    }
    for (const { after, text } of added.sort((a, b) => b.after - a.after)) lines.splice(after + 1, 0, text);
    const blocks = Object.entries(fresh).map(([table, keys]) => {
      const at = "at.1" in keys ? [`at = [${keys["at.1"]}, ${keys["at.2"]}]`] : [];
      const plain = Object.entries(keys).filter(([key]) => !key.startsWith("at.")).map(([key, value]) => `${key} = ${value}`);
      return ["", isDevice(table) ? `[[${table.split(".")[0]}]]` : `[${table}]`, ...plain, ...at].join("\n");
    });
    return [...lines.filter((line) => line !== null), ...blocks].join("\n").replace(/\n*$/, "\n");
  }
  const listOf = (table, key) => `[${Object.keys(numbers).filter((name) => name.startsWith(`${table}.${key}.`)).map((name) => short(numbers[name])).join(", ")}]`;
  const fileName = () => `${(data.key || data.name || "engine").replace(/[^\w-]+/g, "_").slice(0, 40) || "engine"}.toml`;
  function download() {
    const link = make("a", { href: URL.createObjectURL(new Blob([writeFile()], { type: "application/toml" })), download: fileName() });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
  async function copy(text) {
    try { await navigator.clipboard.writeText(text); } catch {
      const area = make("textarea", { value: text });
      document.body.append(area);
      area.select();
      document.execCommand("copy");
      area.remove();
    }
    byId("live-done").textContent = `Copied: ${text.slice(0, 80)}`;
  }

  // ------------------------------------------------------------------ start
  function open(key) {
    data = { ...book.engines[key], key: book.choice ? key : book.file };
    original = Object.fromEntries(data.numbers.map(({ name, value }) => [name, value]));
    [numbers, past, future] = [{ ...original }, [], []];
    const made = Kernel.assemble(data, original);
    before = { made, found: Kernel.compute(made) };
    const { next, wrong } = readAddress();
    if (!apply(next, { remember: false, wrong, rebuild: true })) {
      const told = byId("live-wrong").textContent;
      apply({ ...original }, { remember: false, wrong: [told], rebuild: true });
    }
  }
  function start() {
    const actions = [
      button("Undo", () => step(past, future)), button("Redo", () => step(future, past)),
      button("Reset", () => apply({ ...original }, { rebuild: true })),
      Object.assign(button("Add a counterweight", () => addDevice("counterweight")), { id: "live-add-weight" }),
      button("Add a shaft at −1", () => addDevice("shaft", -1)),
      button("Copy link", () => copy(location.href)),
      ...(book.engines[Object.keys(book.engines)[0]].text ? [button("Download TOML", download), button("Copy command", () => copy(`balcli analyze ${fileName()}`))] : []),
    ];
    byId("live-actions").append(...actions);
    const keys = Object.keys(book.engines), fromAddress = () => {
      const asked = location.hash.match(/[#&]engine=([^&]+)/)?.[1];
      return keys.includes(asked) ? asked : book.choice || keys[0];
    };
    if (book.choice) {
      const select = byId("live-engine");
      select.append(...keys.map((key) => make("option", { value: key }, `${key}: ${book.engines[key].name}`)));
      select.value = fromAddress();
      select.addEventListener("change", () => { history.replaceState(null, "", `#engine=${select.value}`); open(select.value); });
    }
    window.addEventListener("hashchange", () => open(fromAddress()));
    window.Live = { change, apply, writeFile, get numbers() { return numbers; } };
    open(fromAddress());
  }
  const panel = byId("change");
  if (book.choice || location.hash.length > 1) { panel.open = true; start(); } else {
    panel.addEventListener("toggle", start, { once: true });
  }
})();
