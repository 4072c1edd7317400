"use strict";
// The drawing of the engine: its mechanism at a crank angle, devices, and arrows of what shakes it.
const Mechanism = (() => {
const byId = (id) => document.getElementById(id);
const rad = (degrees) => degrees * Math.PI / 180;
const { element } = Charts;
const set = (made, attributes) => {
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
};

// Draws the engine of a scene with devices, in which axes[0] is up; returns a function that turns the drawing.
function draw(scene, devices, axes) {
  for (const id of ["end", "side"]) byId(id).replaceChildren();

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
    for (const d of placed) for (const s of [-0.7 * r, 0.7 * r]) corners.push([d.at[0] + s, d.at[1] + s]);
    const room = 1.6 * r;                                 // for arrows
    corners.push([room, room], [-room, -room]);
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
    const devices = element("g", {}, svg), arrows = element("g", { class: "shake" }, svg);
    for (const { x, y, text } of labels) {
      const place = { x: y, y: -x, "font-size": LETTER };
      element("text", { class: "number", ...place }, svg).textContent = text;
    }
    return (theta, shown, shake) => {
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
      drawDevices(devices, shown, theta);
      drawEndArrows(arrows, shake);
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
    byId("side-caption").textContent = `From ${above ? "below" : "the side"}, free end left, ${axes[above ? 1 : 0]} up`;
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
      };
    });
    for (const cylinder of cylinders) {                       // in front of all pistons
      cylinder.text = element("text", { class: "number", "font-size": 0.26 * bore }, svg);
      cylinder.text.textContent = cylinder.c.number;
    }
    const arrows = element("g", { class: "shake" }, svg);
    return (theta, shake) => {
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
      arrows.replaceChildren();
      for (const { at, vector } of pullsOf(shake)) drawArrow(arrows, at, 0, at, -height(vector));
    };
  }

  // ---------------------------------------------------------------- arrows
  // A shake { force, moment, largest } as pulls at places along the shaft: a force in the middle, a moment as two
  // opposite pulls at the ends. The largest over a revolution has a fixed length.
  function pullsOf({ kind, vector: [x, y], largest }) {
    const scale = largest ? 1.5 * r / largest : 0;
    if (kind === "force") return [{ at: (near + far) / 2, vector: [x * scale, y * scale] }];
    const pull = [y * scale, -x * scale];                 // M = i z F
    const [from, to] = far > near ? [near, far] : [near - bore / 2, far + bore / 2];
    return [{ at: from, vector: [-pull[0], -pull[1]] }, { at: to, vector: pull }];
  }
  function drawEndArrows(group, shake) {
    group.replaceChildren();
    pullsOf(shake).forEach(({ vector: [x, y] }, k) => drawArrow(group, 0, 0, y, -x, k ? "6 4" : ""));
  }
  function drawArrow(group, x1, y1, x2, y2, dashes = "") {
    const long = Math.hypot(x2 - x1, y2 - y1), head = Math.min(0.3 * r, long);
    if (long < 0.02 * r) return;
    const [u, v] = [(x2 - x1) / long, (y2 - y1) / long], [bx, by] = [x2 - head * u, y2 - head * v];
    element("path", { d: `M${x1} ${y1}L${bx} ${by}`, "stroke-width": 0.11 * r, "stroke-dasharray": dashes }, group);
    element("path", { class: "head", d: `M${x2} ${y2}L${bx - 0.5 * head * v} ${by + 0.5 * head * u}L${bx + 0.5 * head * v} ${by - 0.5 * head * u}Z` }, group);
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


  // ---------------------------------------------------------------- places of shafts
  const add = ([a, b], [c, d]) => [a + c, b + d];
  const spin = (v, degrees) => turned(v, degrees);
  const YOKE = 3, SHAFT_WIDTH = 1.6;                      // in crank radii: yoke of harmonic motion, a shaft in the drawing
  // Shafts within the circle of the pins stand beside the engine: those that turn with the crank right of it.
  function placeDevices() {
    const width = Math.max(1.5 * r, ...scene.cylinders.map((c) => {
      const across = Math.abs(Math.sin(rad(c.axis)));
      return across * (radiusOf(c) + (c.rod || YOKE * r) + bore) + (1 - across) * bore;
    }));
    const rows = new Map();
    return devices.map((d) => {
      const ahead = Math.hypot(...d.forward) > 0, beside = d.kind === "shaft" && Math.hypot(...d.at) < r, side = `${ahead}`;
      if (!beside) return { ...d, beside };
      const orders = rows.get(side) || [];
      if (!orders.includes(d.order)) rows.set(side, [...orders, d.order]);
      return { ...d, beside, at: [-SHAFT_WIDTH * r * rows.get(side).indexOf(d.order), (ahead ? 1 : -1) * (width + r)] };
    });
  }
  const placed = placeDevices(), end = endView(), side = sideView();
  const turning = scene.rotary ? "cylinders turn clockwise" : "crank turns clockwise";
  const dashed = placed.some((d) => d.beside) ? "; dashed: on or near the crank axis" : "";
  byId("end-caption").textContent = `Free end, ${axes[0]} up; ${turning}${dashed}`;
  // `present` are the same devices with their present vectors.
  return (theta, shake, present) => {
    end(theta, placed.map(({ at, beside }, k) => ({ ...present[k], at, beside })), shake);
    side(theta, shake);
  };
}
return { draw };
})();
