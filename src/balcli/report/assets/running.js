"use strict";
(() => {
  const running = JSON.parse(document.getElementById("running").textContent);
  const element = (name, attributes, parent) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    parent.append(made);
    return made;
  };
  const WIDE = 600, HIGH = 170, LEFT = 48, RIGHT = 8, TOP = 12;
  const STEPS = [1, 2, 5, 10];
  // Round values between the least and the most, three to six of them, 0 among them.
  const chooseTicks = (least, most) => {
    const rough = (most - least || 1) / 5, power = 10 ** Math.floor(Math.log10(rough));
    const step = STEPS.map((k) => k * power).find((v) => v >= rough * 0.999999);
    const from = Math.ceil(least / step - 1e-9), to = Math.floor(most / step + 1e-9);
    return Array.from({ length: to - from + 1 }, (_, k) => (from + k) * step);
  };
  const slider = document.getElementById("angle");
  slider.max = running.cycle;

  const views = running.curves.map((curve) => {
    const svg = document.getElementById(`${curve.id}-curve`), now = document.getElementById(`${curve.id}-now`);
    svg.setAttribute("viewBox", `0 0 ${LEFT + WIDE + RIGHT} ${HIGH + 2 * TOP + 14}`);
    const all = [...curve.total, ...(curve.gas || []), 0];
    const most = Math.max(...all), least = Math.min(...all);
    const x = (k) => LEFT + WIDE * k * running.step / running.cycle;
    const y = (value) => TOP + HIGH * (most - value) / (most - least || 1);
    const path = (values) => "M" + values.map((v, k) => `${x(k).toFixed(1)} ${y(v).toFixed(1)}`).join("L");
    if (curve.mean !== undefined) {
      const area = `${path(curve.total)} L ${x(curve.total.length - 1)} ${y(curve.mean)} L ${x(0)} ${y(curve.mean)} Z`;
      element("path", { class: "surplus", d: area }, svg);
      element("path", { class: "axis", d: `M ${LEFT} ${y(curve.mean)} H ${LEFT + WIDE}` }, svg);
    }
    element("path", { class: "axis", d: `M ${LEFT} ${y(0)} H ${LEFT + WIDE}` }, svg);
    for (const value of chooseTicks(least, most)) {
      element("path", { class: "axis", d: `M ${LEFT - 4} ${y(value)} H ${LEFT}` }, svg);
      const place = { class: "scale", x: LEFT - 7, y: y(value) + 3, "text-anchor": "end" };
      element("text", place, svg).textContent = String(Number(value.toPrecision(6)));
    }
    element("text", { class: "scale", x: 2, y: TOP - 3 }, svg).textContent = curve.unit;
    for (let mark = 0; mark <= running.cycle; mark += 90) {
      const at = x(mark / running.step);
      element("path", { class: "axis", d: `M ${at} ${TOP} V ${TOP + HIGH}` }, svg);
      const place = { class: "scale", x: at, y: TOP + HIGH + 14, "text-anchor": mark ? "end" : "start" };
      element("text", place, svg).textContent = `${mark}°`;
    }
    if (curve.gas) element("path", { class: "old", d: path(curve.gas) }, svg);
    element("path", { class: "curve", d: path(curve.total) }, svg);
    const line = element("path", { class: "vector" }, svg), tip = element("circle", { class: "tip", r: 3.6 }, svg);
    return (theta) => {
      const place = (theta % running.cycle) / running.step, k = Math.floor(place), share = place - k;
      const value = curve.total[k] * (1 - share) + (curve.total[k + 1] ?? curve.total[k]) * share;
      line.setAttribute("d", `M ${x(place)} ${y(0)} V ${y(value)}`);
      tip.setAttribute("cx", x(place));
      tip.setAttribute("cy", y(value));
      const shown = Math.abs(value) < 1e-9 * (most - least) ? "0" : value.toPrecision(4);  // rounding
      now.textContent = `${shown} ${curve.unit}`;
    };
  });
  document.addEventListener("crank", (event) => { for (const view of views) view(event.detail); });
})();
