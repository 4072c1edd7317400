"use strict";
const Page = {
// Draws the engine of a scene in motion; the chosen orders and crank angle are kept.
draw(scene) {
  const byId = (id) => document.getElementById(id);
  const rad = (degrees) => degrees * Math.PI / 180;
  const element = (name, attributes, parent) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (parent) parent.append(made);
    return made;
  };
  const set = (made, attributes) => {
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  };

  for (const id of ["end", "side", "force", "moment"]) byId(id).replaceChildren();
  const left = new Set([...byId("orders").querySelectorAll("input:not(:checked)")].map((input) => input.value));
  for (const id of ["orders", "variants"]) byId(id).replaceChildren(byId(id).querySelector("legend"));

  // ---------------------------------------------------------------- mechanism
  const r = scene.stroke / 2, bore = scene.bore, crown = 0.42 * bore, skirt = 0.33 * bore;
  const sense = scene.rotary ? -1 : 1;                    // in which a crank pin turns relative to the cylinders

  const radiusOf = (cylinder) => cylinder.radius ?? r;

  // Crank end of the rod and piston pin of a cylinder in its own frame [u along the axis, v ahead of it], mm.
  function drive(cylinder, theta) {
    const psi = rad(theta + cylinder.phase), r = radiusOf(cylinder);
    let lower = [r * Math.cos(psi), r * Math.sin(psi)];
    if (cylinder.master !== undefined) {                  // knuckle pin, turned from the master's frame into this one
      const master = scene.cylinders[cylinder.master], angle = rad(theta + master.phase), lead = rad(cylinder.lead);
      const sine = (r * Math.sin(angle) - master.offset) / master.rod, lean = Math.asin(sine);
      const [a, b] = cylinder.knuckle;
      const u = r * Math.cos(angle) + a * Math.cos(lean) + b * Math.sin(lean);
      const v = r * Math.sin(angle) - a * Math.sin(lean) + b * Math.cos(lean);
      lower = [u * Math.cos(lead) + v * Math.sin(lead), v * Math.cos(lead) - u * Math.sin(lead)];
    }
    const beside = lower[1] - cylinder.offset;
    const place = lower[0] + (cylinder.rod ? Math.sqrt(cylinder.rod ** 2 - beside ** 2) : 3 * r);    // else a yoke
    return {
      lower: [lower[0], sense * lower[1]],
      piston: [place, sense * cylinder.offset],
      axis: cylinder.axis + (scene.rotary ? theta + cylinder.phase : 0),
    };
  }
  const turned = ([u, v], degrees) => {
    const a = rad(degrees);
    return [u * Math.cos(a) - v * Math.sin(a), u * Math.sin(a) + v * Math.cos(a)];
  };
  const pinAngle = (cylinder, theta) => scene.rotary ? cylinder.axis : cylinder.axis + cylinder.phase + theta;
  const plain = scene.cylinders.filter((c) => c.master === undefined);
  const depths = scene.cylinders.map((c) => c.z), near = Math.min(...depths), far = Math.max(...depths);
  const places = (c) => Array.from({ length: 72 }, (_, k) => drive(c, 5 * k).piston[0]);
  const reach = Math.max(...scene.cylinders.map((c) => Math.max(...places(c)))) + crown;
  const backToFront = [...scene.cylinders].sort((a, b) => b.z - a.z);

  // Numbers of the cylinders of each bank, beyond its end.
  const LETTER = 0.2 * bore;
  function bankLabels() {
    const banks = new Map();
    for (const c of scene.rotary ? [] : scene.cylinders) banks.set(c.axis, [...(banks.get(c.axis) || []), c.number]);
    return [...banks].map(([axis, numbers]) => {
      const shown = numbers.length > 6 ? [...numbers.slice(0, 5), "…"] : numbers;
      const text = shown.join(" "), wide = 0.3 * LETTER * text.length, high = 0.6 * LETTER;
      const [x, y] = turned([reach + 0.3 * LETTER + high + (wide - high) * Math.abs(Math.sin(rad(axis))), 0], axis);
      return { text, x, y, wide, high };
    });
  }

  function endView() {
    const svg = byId("end"), corners = [[r * 1.5, 0], [-r * 1.5, 0], [0, r * 1.5], [0, -r * 1.5]];
    for (const c of scene.cylinders) {
      const angles = scene.rotary ? Array.from({ length: 24 }, (_, k) => 15 * k) : [c.axis];
      for (const a of angles) for (const v of [-0.6 * bore, 0.6 * bore]) corners.push(turned([reach * 1.03, v], a));
    }
    for (const d of scene.variants.flatMap((variant) => variant.devices)) {
      for (const s of [-0.7 * r, 0.7 * r]) corners.push([d.at[0] + s, d.at[1] + s]);
    }
    const labels = bankLabels();
    for (const { x, y, wide, high } of labels) corners.push([x + high, y - wide], [x - high, y + wide]);
    frame(svg, corners.map(([x, y]) => [y, -x]));
    const cylinders = backToFront.map((c) => {
      const behind = far > near ? (c.z - near) / (far - near) : 0;
      const group = element("g", { opacity: 1 - 0.65 * behind }, svg), own = element("g", {}, group);
      const low = Math.min(...places(c)) - skirt, e = sense * c.offset;
      element("path", { class: "bore", d: `M ${e - bore / 2} ${-low} V ${-reach} H ${e + bore / 2} V ${-low}` }, own);
      element("path", { class: "axis dashed", d: `M ${e} 0 V ${-reach * 1.03}` }, own);
      const rod = element("line", { class: "rod", "stroke-width": 0.24 * r }, own);
      const outline = `M ${-bore * 0.485} ${skirt} V ${-crown} H ${bore * 0.485} V ${skirt} Z`;
      const piston = element("path", { class: "piston", d: outline }, own);
      const pin = element("circle", { class: "pin", r: 0.16 * r }, own);
      return { c, own, rod, piston, pin };
    });
    const crank = element("g", { opacity: 0.92 }, svg);
    const knuckles = Math.max(0, ...scene.cylinders.map((c) => c.master === undefined ? 0 : Math.hypot(...c.knuckle)));
    const bigEnd = element("circle", { class: "web", r: knuckles ? knuckles + 0.2 * r : 0 }, crank);
    const eyes = scene.cylinders.filter((c) => c.master !== undefined)
      .map((c) => ({ c, eye: element("circle", { class: "pin", r: 0.13 * r }, crank) }));
    const webs = plain.map((c) => ({
      c,
      web: element("path", { class: "web", d: web(radiusOf(c)) }, crank),
      pin: element("circle", { class: "pin", r: 0.2 * r }, crank),
    }));
    element("circle", { class: "pin", r: 0.26 * r }, crank);
    const devices = element("g", {}, svg);
    for (const { x, y, text } of labels) {
      const place = { x: y, y: -x, "font-size": LETTER };
      element("text", { class: "number", ...place }, svg).textContent = text;
    }
    return (theta, variant) => {
      for (const { c, own, rod, piston, pin } of cylinders) {
        const { lower, piston: at, axis } = drive(c, theta);
        set(own, { transform: `rotate(${axis})` });
        set(rod, { x1: lower[1], y1: -lower[0], x2: at[1], y2: -at[0] });
        set(piston, { transform: `translate(${at[1]} ${-at[0]})` });
        set(pin, { cx: at[1], cy: -at[0] });
      }
      const [up, right] = turned([radiusOf(plain[0]), 0], pinAngle(plain[0], theta));
      set(bigEnd, { cx: right, cy: -up });
      for (const { c, eye } of eyes) {
        const { lower, axis } = drive(c, theta), [x, y] = turned(lower, axis);
        set(eye, { cx: y, cy: -x });
      }
      for (const { c, web: shape, pin } of webs) {
        const angle = pinAngle(c, theta);
        set(shape, { transform: `rotate(${angle})` });
        set(pin, { transform: `rotate(${angle})`, cx: 0, cy: -radiusOf(c) });
      }
      drawDevices(devices, variant.devices, theta);
    };
  }
  const web = (r) => {
    const small = 0.3 * r, large = 0.36 * r;              // radii about the pin and about the shaft
    return `M ${-small} ${-r} A ${small} ${small} 0 0 1 ${small} ${-r} `
      + `L ${large} 0 A ${large} ${large} 0 0 1 ${-large} 0 Z`;
  };

  // A weight as half a disc that points where it pulls; a slider as a block on its path.
  function drawDevices(group, devices, theta) {
    const sizeOf = (d) => Math.hypot(...d.forward) + Math.hypot(...d.backward);
    const most = Math.max(...devices.map(sizeOf)) || 1;
    group.replaceChildren();
    for (const d of devices) {
      const size = sizeOf(d), [x, y] = d.at, radius = (0.2 + 0.5 * Math.sqrt(size / most)) * r;
      if (Math.hypot(...d.forward) && Math.hypot(...d.backward)) {
        const v = add(spin(d.forward, d.order * theta), spin(d.backward, -d.order * theta)), k = radius / size;
        element("circle", { class: "weight", cx: y + v[1] * k, cy: -x - v[0] * k, r: radius / 2 }, group);
        continue;
      }
      const v = add(spin(d.forward, d.order * theta), spin(d.backward, -d.order * theta));
      const angle = Math.atan2(v[1], v[0]) * 180 / Math.PI;
      const place = `translate(${y} ${-x}) rotate(${angle})`;
      element("circle", { class: d.beside ? "shaft dashed" : "shaft", r: radius, transform: place }, group);
      const half = `M ${-radius} 0 A ${radius} ${radius} 0 0 1 ${radius} 0 Z`;
      element("path", { class: "weight", d: half, transform: place }, group);
    }
  }

  function sideView() {
    const svg = byId("side"), all = plain.concat(scene.cylinders);
    const spread = (f) => all.reduce((sum, c) => sum + f(rad(c.axis)) ** 2, 0);
    const above = !scene.rotary && spread(Math.sin) > spread(Math.cos) * 1.01;      // flat engines are seen from below
    const height = ([x, y]) => above ? y : x;
    byId("side-caption").textContent = `From ${above ? "below" : "the side"}: `
      + `z to the right, free end on the left; ${scene.axes[above ? 1 : 0]} up`;
    const corners = [[near - bore * 0.75, -1.4 * r], [far + bore * 0.75, 1.4 * r]];
    for (const c of scene.cylinders) {
      for (const v of [-0.5 * bore, 0.5 * bore]) {
        for (const a of scene.rotary ? [0, 90, 180, 270] : [c.axis]) {
          corners.push([c.z, height(turned([reach * 1.04, v], a))]);
        }
      }
    }
    frame(svg, corners.map(([z, h]) => [z, -h]));
    element("path", { class: "axis dashed", d: `M ${near - bore} 0 H ${far + bore}` }, svg);
    const crank = element("g", {}, svg);
    const throws = throwsOf(), thick = Math.min(0.16 * r, 0.2 * throwWidth);
    const shaft = element("path", { class: "crank", "stroke-width": thick }, crank);
    const cylinders = backToFront.map((c) => {
      const group = element("g", { opacity: 0.8 }, svg);
      const thickness = Math.min(0.2 * r, 0.4 * throwWidth);
      return {
        c,
        rod: element("line", { class: "rod", "stroke-width": thickness }, group),
        piston: element("rect", { class: "piston" }, group),
        text: element("text", { class: "number", "font-size": 0.26 * bore }, group),
      };
    });
    for (const { c, text } of cylinders) text.textContent = c.number;
    return (theta) => {
      const bend = (c) => -height(turned([radiusOf(c), 0], pinAngle(c, theta)));
      const bends = throws.map(({ c, from, to }) => `H ${from} V ${bend(c)} H ${to} V 0`);
      set(shaft, { d: `M ${near - bore * 0.6} 0 ${bends.join(" ")} H ${far + bore * 0.6}` });
      for (const { c, rod, piston, text } of cylinders) {
        const { lower, piston: at, axis } = drive(c, theta);
        const top = height(turned([at[0] + crown, at[1]], axis)), bottom = height(turned([at[0] - skirt, at[1]], axis));
        const across = bore * Math.abs(height(turned([0, 1], axis)));               // of a bank that leans
        const high = Math.max(top, bottom) + across / 2, low = Math.min(top, bottom) - across / 2;
        set(rod, { x1: c.z, y1: -height(turned(lower, axis)), x2: c.z, y2: -height(turned(at, axis)) });
        set(piston, { x: c.z - bore * 0.485, y: -high, width: bore * 0.97, height: high - low });
        set(text, { x: c.z, y: -(high + low) / 2 });
      }
    };
  }
  const planes = [...new Set(depths.map((z) => Math.round(z * 10) / 10))].sort((a, b) => a - b);
  const gaps = planes.map((z, k) => k ? z - planes[k - 1] : Infinity);
  const throwWidth = Math.min(0.5 * bore, 0.6 * Math.min(...gaps));

  // Crank pins along the shaft; neighbouring rods whose pins point the same way stand on one.
  function throwsOf() {
    const found = [], same = (a, b) => Math.abs(((pinAngle(a, 0) - pinAngle(b, 0)) % 360 + 540) % 360 - 180) < 0.01
      && radiusOf(a) === radiusOf(b);
    for (const c of [...plain].sort((a, b) => a.z - b.z)) {
      const last = found.at(-1);
      if (last && same(last.c, c) && c.z - last.to < 0.5 * bore) last.to = c.z + throwWidth / 2;
      else found.push({ c, from: c.z - throwWidth / 2, to: c.z + throwWidth / 2 });
    }
    return found;
  }

  function frame(svg, points) {
    const xs = points.map((p) => p[0]), ys = points.map((p) => p[1]), margin = 0.03 * scene.stroke;
    const left = Math.min(...xs) - margin, top = Math.min(...ys) - margin;
    const wide = Math.max(...xs) + margin - left, high = Math.max(...ys) + margin - top;
    svg.setAttribute("viewBox", [left, top, wide, high].map((v) => v.toFixed(2)).join(" "));
  }

  // ---------------------------------------------------------------- vectors
  const add = ([a, b], [c, d]) => [a + c, b + d];
  const spin = (v, degrees) => turned(v, degrees);
  const ofOrder = ([n, a, b, c, d], theta) => add(spin([a, b], n * theta), spin([c, d], -n * theta));
  const sum = (rows, theta) => rows.reduce((v, row) => add(v, ofOrder(row, theta)), [0, 0]);
  const STEPS = [1, 1.2, 1.5, 2, 2.5, 3, 4, 5, 6, 8, 10];
  const nice = (value) => {
    const power = 10 ** Math.floor(Math.log10(value));
    return STEPS.map((k) => k * power).find((v) => v >= value * 0.999999);
  };
  const digits = (value) => value >= 1000 ? value.toFixed(0) : value.toPrecision(4);
  const round = (value) => String(Number(value.toPrecision(4)));
  // A value with its unit, or with the thousandfold unit if the value, or the largest one shown with it, is large.
  function figure(value, { name, thousand }, write = digits, largest = value) {
    return thousand && largest >= 5000 ? `${write(value / 1000)} ${thousand}` : `${write(value)} ${name}`;
  }
  const HALF = 100;

  function locusView(id, unit) {
    const svg = byId(id), now = byId(`${id}-now`);
    svg.setAttribute("viewBox", "-112 -112 224 224");
    element("path", { class: "axis", d: "M -108 0 H 108 M 0 -108 V 108" }, svg);
    const rings = [0.5, 1].map((share) => ({
      share,
      ring: element("circle", { class: "axis", r: HALF * share }, svg),
      label: element("text", { class: "scale", x: 3, y: -HALF * share - 2 }, svg),
    }));
    element("text", { class: "scale", x: -9, y: -104 }, svg).textContent = scene.axes[0][0];
    element("text", { class: "scale", x: 104, y: -3 }, svg).textContent = scene.axes[1][0];
    const old = element("path", { class: "old" }, svg);
    const curve = element("path", { class: "curve" }, svg), chain = element("g", {}, svg);
    const line = { class: "vector", id: `${id}-vector`, x1: 0, y1: 0 };
    const vector = element("line", line, svg), tip = element("circle", { class: "tip", r: 3.2 }, svg);
    let rows = [], scale = 1;
    const point = ([x, y]) => `${(y * scale).toFixed(2)} ${(-x * scale).toFixed(2)}`;
    const turns = (of) => Array.from({ length: 361 }, (_, k) => sum(of, k));
    const path = (values) => "M" + values.map(point).join("L");
    const largest = (values) => Math.max(0, ...values.map((v) => Math.hypot(...v)));
    return {
      choose(all, before) {
        rows = all;
        const values = turns(rows), earlier = before ? turns(before) : [];
        const most = Math.max(largest(values), largest(earlier)), matters = most && most >= unit.least;
        const full = nice(matters ? most : 1000 * unit.least || 1);
        scale = HALF / full;
        for (const { share, label } of rings) label.textContent = most ? figure(full * share, unit, round, full) : "";
        set(curve, { d: path(values) });
        set(old, { d: before ? path(earlier) : "" });
      },
      turn(theta, showChain) {
        const [x, y] = sum(rows, theta), size = Math.hypot(x, y);
        set(vector, { x2: (y * scale).toFixed(3), y2: (-x * scale).toFixed(3) });
        set(tip, { cx: y * scale, cy: -x * scale });
        const whole = Math.round(Math.atan2(y, x) * 180 / Math.PI);
        const direction = String(whole === -180 ? 180 : whole + 0).replace("-", "−");
        const where = size < unit.least ? "negligible" : `at ${direction}° from ${scene.axes[0]}`;
        now.textContent = size ? `${figure(size, unit)} ${where}` : "balanced";
        chain.replaceChildren();
        let at = [0, 0];
        const links = (showChain ? rows : []).flatMap(([n, a, b, c, d]) => [
          ["forward", [a, b], n],
          ["backward", [c, d], -n],
        ]);
        for (const [kind, v, order] of links) {
          const next = add(at, spin(v, order * theta)), length = Math.hypot(...v) * scale;
          if (length > 0.5) {
            const from = { x1: at[1] * scale, y1: -at[0] * scale };
            const to = { x2: next[1] * scale, y2: -next[0] * scale };
            element("line", { class: kind, ...from, ...to }, chain);
            element("circle", { class: "axis", cx: at[1] * scale, cy: -at[0] * scale, r: length }, chain);
          }
          at = next;
        }
      },
    };
  }

  // ---------------------------------------------------------------- controls
  const turning = scene.rotary ? "the cylinders turn clockwise, the crank stands still" : "the crank turns clockwise";
  const beside = scene.variants.some((variant) => variant.devices.some((d) => d.beside));
  byId("end-caption").textContent = `From the free end: ${scene.axes[0]} up, ${scene.axes[1]} to the right; ${turning}`
    + (beside ? ". Dashed: shafts on or near the crank axis, drawn next to the engine" : "");
  const end = endView(), side = sideView();
  const views = {
    force: locusView("force", scene.units.force),
    moment: locusView("moment", scene.units.moment),
  };
  const angle = byId("angle"), play = byId("play"), chain = byId("chain");
  const cycle = Number(angle.max);                        // 720 with the gas of a four-stroke
  const switchFor = (parent, type, name, value, text, checked) => {
    const label = document.createElement("label"), input = document.createElement("input");
    Object.assign(input, { type, name, value, checked });
    label.append(input, ` ${text}`);
    byId(parent).append(label);
    return input;
  };
  const orders = scene.orders.map((n) =>
    switchFor("orders", "checkbox", "order", n, n === 0 ? "mean" : n, !left.has(String(n))));
  if (!orders.length) byId("orders").append("balanced");
  const variants = scene.variants.map((v, k) => switchFor("variants", "radio", "variant", k, v.label, k === (scene.shown || 0)));
  byId("variants").hidden = variants.length < 2;

  const chosen = () => Math.max(variants.findIndex((input) => input.checked), 0);
  function choose() {
    const wanted = new Set(orders.filter((input) => input.checked).map((input) => Number(input.value)));
    for (const [quantity, view] of Object.entries(views)) {
      const pick = (k) => scene.variants[k][quantity].filter((row) => wanted.has(row[0]));
      view.choose(pick(chosen()), chosen() ? pick(0) : null);
    }
    turn();
  }
  function turn() {
    const theta = Number(angle.value);
    byId("angle-now").textContent = `${Math.round(theta) % cycle}°`;
    end(theta, scene.variants[chosen()]);
    side(theta);
    for (const view of Object.values(views)) view.turn(theta, chain.checked);
    document.dispatchEvent(new CustomEvent("crank", { detail: theta }));
  }
  Page.turn = angle.oninput = chain.onchange = turn;
  for (const input of [...orders, ...variants]) input.addEventListener("change", choose);

  choose();
},

// Animation and colours, once.
start() {
  const byId = (id) => document.getElementById(id);
  const angle = byId("angle"), play = byId("play"), theme = byId("theme");
  const DEGREES_PER_SECOND = 60;
  let last = null;
  function step(time) {
    if (play.getAttribute("aria-pressed") !== "true") { last = null; return; }
    if (last !== null) {
      angle.step = "any";
      angle.value = (Number(angle.value) + DEGREES_PER_SECOND * (time - last) / 1000) % Number(angle.max);
      Page.turn();
    }
    last = time;
    requestAnimationFrame(step);
  }
  play.addEventListener("click", () => {
    const on = play.getAttribute("aria-pressed") !== "true";
    play.setAttribute("aria-pressed", on);
    play.textContent = on ? "Pause" : "Play";
    if (on) requestAnimationFrame(step);
    else { angle.step = "1"; angle.value = Math.round(Number(angle.value)); Page.turn(); }
  });
  theme.hidden = false;
  theme.addEventListener("click", () => {
    const set = document.documentElement.dataset.theme;
    const dark = set ? set === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
    document.documentElement.dataset.theme = dark ? "light" : "dark";
  });
},
};
Page.start();
if (document.getElementById("scene")) Page.draw(JSON.parse(document.getElementById("scene").textContent));
