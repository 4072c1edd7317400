"use strict";
// The text of an engine file with other numbers: a line changes its number and keeps its comment.
const EngineText = (() => {
  const { DEVICE, tableOf } = Numbers;
  const HEADER = /^\s*(\[{1,2})\s*([\w.-]+)\s*\]{1,2}/;
  const VALUE = /^(\s*\w+\s*=\s*)(?:"[^"]*"|'[^']*'|\[[^\]]*\]|[^\s#]+)/;
  const isEmptyOrComment = (line) => /^\s*(#|$)/.test(line);

  // Changes are [name, value] with "none" for what is gone; `settings` are further [key, value] of the table layout.
  function write(text, numbers, changes, settings) {
    const file = parse(text);
    for (const [name, value] of changes) writeChange(file, numbers, name, value);
    for (const [key, value] of settings) put(file, "layout", key, value);
    const joined = join(file);
    return text.includes("\r\n") ? joined.replaceAll("\n", "\r\n") : joined;
  }

  // Lines and tables of a text; `added` are lines to insert, `fresh` lines of new tables by name.
  function parse(text) {
    const lines = text.split(/\r?\n/);
    const tables = [];
    const counts = {};
    lines.forEach((line, row) => {
      const [, brackets, name] = line.match(HEADER) || [];
      if (!name) return;
      if (brackets === "[[") counts[name] = (counts[name] || 0) + 1;
      tables.push({ name: brackets === "[[" ? `${name}.${counts[name]}` : name, from: row });
    });
    tables.forEach((table, k) => { table.to = tables[k + 1]?.from ?? lines.length; });
    return { lines, tables, added: [], fresh: {} };
  }
  const findTable = ({ tables }, name) => tables.find((table) => table.name === name);

  function writeChange(file, numbers, name, value) {
    const table = tableOf(name);
    if (name === table) {
      removeTable(file, findTable(file, table));
      return;
    }
    const [key, member] = name.slice(table.length + 1).split(".");
    put(file, table, key, member ? writeList(numbers, `${table}.${key}`) : value);
  }
  function writeList(numbers, path) {
    const members = Object.keys(numbers).filter((name) => name.startsWith(`${path}.`));
    return `[${members.map((name) => numbers[name]).join(", ")}]`;
  }
  // Comments before the next table stay.
  function removeTable({ lines }, { from, to }) {
    let end = to;
    while (end > from + 1 && isEmptyOrComment(lines[end - 1] || "")) end--;
    lines.fill(null, from, end);
  }
  function put(file, name, key, value) {
    const { lines, added, fresh } = file;
    const table = findTable(file, name);
    const row = table ? findRow(lines, table, key) : -1;
    if (row >= 0) lines[row] = value === "none" ? null : lines[row].replace(VALUE, (_, start) => start + value);
    else if (value === "none") return;
    else if (table) added.push({ after: table.from, line: `${key} = ${value}` });
    else (fresh[name] ??= []).push(`${key} = ${value}`);
  }
  function findRow(lines, { from, to }, key) {
    const assigns = new RegExp(`^\\s*${key}\\s*=`);
    return lines.findIndex((line, row) => row > from && row < to && line !== null && assigns.test(line));
  }
  function join({ lines, added, fresh }) {
    const fromBelow = added.sort((a, b) => b.after - a.after);   // so that places above stay
    for (const { after, line } of fromBelow) lines.splice(after + 1, 0, line);
    const blocks = Object.entries(fresh).map(([table, rows]) => {
      const head = DEVICE.test(table) ? `[[${table.split(".")[0]}]]` : `[${table}]`;
      return ["", head, ...new Set(rows)].join("\n");
    });
    const kept = lines.filter((line) => line !== null);
    return [...kept, ...blocks].join("\n").replace(/\n*$/, "\n");
  }

  return { write };
})();
