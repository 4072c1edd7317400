"""An audit of a page in a browser: the rules of the Web Content Accessibility Guidelines 2.1 (level AA) that concern
what the page uses, as checkers such as axe report them as serious.
"""

AUDIT = r"""
(() => {
  const wrong = [];
  const describe = (node) => {
    const name = node.id ? `#${node.id}` : node.getAttribute("class") ? `.${node.getAttribute("class").split(" ")[0]}` : "";
    return `${node.localName}${name}` + (name ? "" : ` in ${node.closest("[id]")?.id || "body"}`);
  };
  const isShown = (node) => node.checkVisibility({ checkVisibilityCSS: true }) && !node.closest("[aria-hidden=true]");
  const all = (selector) => [...document.querySelectorAll(selector)].filter(isShown);
  const report = (rule, node, more = "") => wrong.push(`${rule}: ${describe(node)} ${more}`.trim());

  // names of controls and pictures
  const nameOf = (node) => node.getAttribute("aria-label") || [...node.labels || []].map((label) => label.textContent).join(" ")
    || (["INPUT", "SELECT", "TEXTAREA"].includes(node.tagName) ? "" : node.textContent) || node.title || "";
  for (const node of all("button, a[href], input, select, textarea, summary")) if (!nameOf(node).trim()) report("no name", node);
  for (const node of all("[role=img], [role=region], section[aria-label], nav")) if (!node.getAttribute("aria-label")) report("no name", node);
  for (const node of all("img:not([alt])")) report("no alternative text", node);

  // roles and attributes of ARIA
  const NAMELESS = "div, span, p, dl, dd, dt, figcaption, small, b, code";
  for (const node of all("[aria-label]")) if (node.matches(NAMELESS) && !node.getAttribute("role")) report("a name without a role", node);
  for (const node of all("[aria-pressed]")) if (node.localName !== "button") report("pressed, but no button", node);
  for (const node of all("[aria-hidden=true] :is(button, a, input, [tabindex])")) report("hidden, but focusable", node);
  for (const node of all("[tabindex]")) if (node.tabIndex > 0) report("order of tabs", node);
  const ids = [...document.querySelectorAll("[id]")].map(({ id }) => id);
  for (const id of new Set(ids)) if (ids.filter((other) => other === id).length > 1) wrong.push(`id twice: ${id}`);
  for (const node of all("[for], [aria-labelledby], [aria-describedby], [aria-controls]")) {
    const named = ["for", "aria-labelledby", "aria-describedby", "aria-controls"].flatMap((key) => (node.getAttribute(key) || "").split(" ").filter(Boolean));
    for (const id of named) if (!document.getElementById(id)) report("refers to nothing", node, id);
  }
  for (const node of all("a[href^='#']")) if (!document.getElementById(node.hash.slice(1))) report("leads nowhere", node, node.hash);

  // headings, landmarks, lists
  if (!document.documentElement.lang || !document.title) wrong.push("no language or title");
  if (all("h1").length !== 1) wrong.push(`${all("h1").length} headings of the first level`);
  let level = 0;
  for (const node of all("h1, h2, h3, h4")) {
    const own = Number(node.localName[1]);
    if (own > level + 1) report("skips a level", node);
    if (!node.textContent.trim()) report("empty", node);
    level = own;
  }
  if (all("main").length !== 1 || all("header").length !== 1) wrong.push("landmarks");
  for (const node of document.body.children) {
    const outside = isShown(node) && node.getBoundingClientRect().height && !node.matches("header, main, nav, footer, script, svg");
    if (outside) report("outside of all landmarks", node);
  }
  for (const node of all("ul > *, ol > *")) if (node.localName !== "li") report("in a list, but no item", node);
  for (const node of all("dl > *")) if (!["DIV", "DT", "DD"].includes(node.tagName)) report("in a list of pairs", node);

  // tables
  for (const table of all("table")) {
    const heads = [...table.querySelectorAll("th")];
    if (!heads.length) report("no headers", table);
    for (const head of heads) if (!["row", "col"].includes(head.scope)) report("a header without scope", head);
    for (const row of table.tBodies[0]?.rows || []) if (row.cells[0].localName !== "th") report("a row without header", row);
  }

  // what scrolls can be reached by keyboard
  for (const node of all("body *")) {
    const style = getComputedStyle(node), scrolls = /auto|scroll/.test(style.overflowX + style.overflowY);
    const larger = node.scrollWidth > node.clientWidth + 1 || node.scrollHeight > node.clientHeight + 1;
    const reached = node.tabIndex >= 0 || node.querySelector("a[href], button, input, select, [tabindex='0']");
    if (scrolls && larger && !reached) report("scrolls, but not by keyboard", node);
  }

  // contrast of texts
  const context = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
  const read = (color) => {
    context.clearRect(0, 0, 1, 1);
    context.fillStyle = color;
    context.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = context.getImageData(0, 0, 1, 1).data;
    return { rgb: [r, g, b], a: a / 255 };
  };
  const over = (top, a, below) => top.map((value, k) => a * value + (1 - a) * below[k]);
  const backgroundOf = (node) => {
    const layers = [];
    for (let at = node; at; at = at.parentElement) {
      const layer = read(getComputedStyle(at).backgroundColor);
      if (layer.a) layers.push(layer);
      if (layer.a === 1) break;
    }
    return layers.reverse().reduce((below, { rgb, a }) => over(rgb, a, below), [255, 255, 255]);
  };
  const luminance = (rgb) => {
    const [r, g, b] = rgb.map((v) => v / 255).map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let text = texts.nextNode(); text; text = texts.nextNode()) {
    const node = text.parentElement;
    if (!text.data.trim() || node.matches("script, style, option") || !isShown(node) || node.closest(":disabled, .spoken")) continue;
    if (node.closest("label")?.querySelector(":disabled")) continue;
    const style = getComputedStyle(node), background = backgroundOf(node);
    let opacity = 1, gray = false;
    for (let at = node; at; at = at.parentElement) {
      opacity *= Number(getComputedStyle(at).opacity);
      gray ||= getComputedStyle(at).filter.includes("grayscale(1)");
    }
    const own = read(node instanceof SVGElement ? style.fill : style.color);
    const toGray = (rgb) => Array(3).fill(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]);
    const color = over(gray ? toGray(own.rgb) : own.rgb, own.a * opacity, background);
    const [high, low] = [luminance(color), luminance(background)].sort((a, b) => b - a), ratio = (high + 0.05) / (low + 0.05);
    const large = parseFloat(style.fontSize) >= 24 || (parseFloat(style.fontSize) >= 18.66 && style.fontWeight >= 700);
    if (ratio < (large ? 3 : 4.5)) report(`contrast ${ratio.toFixed(2)}`, node, `"${text.data.trim().slice(0, 30)}"`);
  }
  return [...new Set(wrong)];
})()
"""
