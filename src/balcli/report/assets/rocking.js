"use strict";
(() => {
  const data = JSON.parse(document.getElementById("rocking-data").textContent);
  const byId = (id) => document.getElementById(id);
  const svg = byId("rocking"), speed = byId("rocking-speed"), play = byId("rocking-play");
  const element = (name, attributes) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    svg.append(made);
    return made;
  };
  const flat = (p) => data.projection.map((row) => row.reduce((sum, share, k) => sum + share * p[k], 0));
  const onPage = (p) => { const [right, up] = flat(p); return [right, -up]; };
  const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  const size = Math.max(...data.corners.flat().map(Math.abs));

  // Motion of the centre of gravity at a crank angle (rad): three displacements, three turns.
  function motion(theta) {
    const found = [0, 0, 0, 0, 0, 0];
    data.motion[Number(speed.value)].forEach((row, n) => {
      const c = Math.cos(data.orders[n] * theta), s = Math.sin(data.orders[n] * theta);
      for (let k = 0; k < 6; k += 1) found[k] += row[k] * c + row[k + 6] * s;
    });
    return found;
  }
  const shift = (q, p) => { const turn = cross(q.slice(3), p); return [0, 1, 2].map((k) => q[k] + turn[k]); };
  const moved = (q, p, scale) => { const way = shift(q, p); return [0, 1, 2].map((k) => p[k] + scale * way[k]); };
  const outline = (corner) => {
    const lines = [];
    for (let i = 0; i < 8; i += 1) {
      for (const bit of [1, 2, 4]) if (!(i & bit)) lines.push(`M ${corner(i)} L ${corner(i | bit)}`);
    }
    return lines.join(" ");
  };

  const edge = [...data.corners, ...data.mounts].map(onPage), room = 0.45 * size;
  const [left, right] = [Math.min, Math.max].map((f, k) => f(...edge.map((p) => p[0])) + (k ? room : -room));
  const [top, bottom] = [Math.min, Math.max].map((f, k) => f(...edge.map((p) => p[1])) + (k ? room : -room));
  svg.setAttribute("viewBox", `${left} ${top} ${right - left} ${bottom - top}`);
  element("path", { class: "axis", d: outline((i) => onPage(data.corners[i]).join(" ")) });
  const springs = data.mounts.map((p) => {
    const [x, y] = onPage(p);
    element("circle", { class: "bore", cx: x, cy: y, r: 0.03 * size });
    return { p, line: element("path", { class: "rod", "stroke-width": 0.012 * size }), x, y };
  });
  const block = element("path", { class: "curve" });
  const feet = data.mounts.map(() => element("circle", { class: "weight", r: 0.03 * size }));

  let scale = 1;
  function choose() {
    let largest = 0;
    for (let k = 0; k < 360; k += 1) {
      const q = motion(k * Math.PI / 90);
      for (const p of data.corners) largest = Math.max(largest, Math.hypot(...shift(q, p)));
    }
    scale = largest ? 0.3 * size / largest : 1;
    byId("rocking-now").textContent = `${data.speeds[Number(speed.value)]} rpm`;
    byId("rocking-scale").textContent = `drawn ${Number(scale.toPrecision(2))} times as far as it moves`;
    draw();
  }
  let theta = 0;
  function draw() {
    const q = motion(theta);
    block.setAttribute("d", outline((i) => onPage(moved(q, data.corners[i], scale)).join(" ")));
    springs.forEach(({ p, line, x, y }, k) => {
      const [right, down] = onPage(moved(q, p, scale));
      line.setAttribute("d", `M ${x} ${y} L ${right} ${down}`);
      feet[k].setAttribute("cx", right);
      feet[k].setAttribute("cy", down);
    });
  }
  speed.addEventListener("input", choose);

  const DEGREES_PER_SECOND = 120;
  Motion.attach(play, DEGREES_PER_SECOND, (degrees) => {
    theta = (theta + degrees * Math.PI / 180) % (4 * Math.PI);
    draw();
  });
  choose();
})();
