"use strict";
// The table of runs: search, filters, order, columns. What is chosen stands in the address, so that a view can be kept or sent on.
(() => {
  const table = document.querySelector("table.runs"), body = table.tBodies[0], heads = [...table.tHead.rows[0].cells];
  const rows = [...body.rows].map((tr) => ({ tr, text: null, cells: tr.cells }));
  const $ = (id) => document.getElementById(id), collator = new Intl.Collator(undefined, { numeric: true });
  const title = (th) => th.dataset.title;
  const state = { q: "", vehicle: "", verdict: "", state: "", sort: "", hide: "" };
  const keys = Object.keys(state);
  const said = (row, column) => (row.cells[column] ? row.cells[column].dataset.v ?? row.cells[column].textContent : "");
  const column = (name) => heads.findIndex((th) => title(th) === name);

  const show = () => {
    const words = state.q.toLowerCase().split(/\s+/).filter(Boolean), wanted = ["vehicle", "verdict", "state"].filter((k) => state[k]).map((k) => [column(k), state[k]]);
    let shown = 0;
    for (const row of rows) {
      if (words.length) row.text ??= row.tr.textContent.toLowerCase();
      const fits = words.every((w) => row.text.includes(w)) && wanted.every(([c, v]) => said(row, c).split("\n")[0].includes(v));
      if (row.tr.hidden === fits) row.tr.hidden = !fits;
      shown += fits;
    }
    $("shown").textContent = shown === rows.length ? `${shown} runs` : `${shown} of ${rows.length} runs`;
  };
  const order = () => {
    const [name, way] = state.sort.split(":"), c = column(name);
    heads.forEach((th, i) => th.setAttribute("aria-sort", i !== c ? "none" : way === "down" ? "descending" : "ascending"));
    if (c < 0) return;
    const sign = way === "down" ? -1 : 1, keyed = rows.map((row) => [said(row, c).trim(), row.tr]);
    const missing = (v) => v === "" || v === "-";
    const numbers = keyed.every(([v]) => missing(v) || Number.isFinite(Number(v)));
    keyed.sort(([a], [b]) => missing(a) - missing(b) || sign * (numbers ? a - b : collator.compare(a, b)));
    body.append(...keyed.map(([, tr]) => tr));
  };
  const columns = () => {
    const hidden = new Set(state.hide.split(",").filter(Boolean));
    style.textContent = heads.map((th, i) => (hidden.has(title(th)) ? `table.runs tr > :nth-child(${i + 1}) { display: none }` : "")).join("");
    document.querySelectorAll("#columns input").forEach((box) => { box.checked = !hidden.has(box.value); });
  };
  const keep = () => history.replaceState(null, "", "#" + new URLSearchParams(keys.filter((k) => state[k]).map((k) => [k, state[k]])));

  const options = (select, c) => {
    const found = c < 0 ? [] : [...new Set(rows.flatMap((row) => said(row, c).split("\n")[0].split(", ")))].filter(Boolean).sort(collator.compare);
    if (found.length < 2 && select.id !== "state") { select.parentNode.hidden = true; return; }
    found.forEach((v) => select.add(new Option(v, v)));
    select.parentNode.hidden = !found.length;
  };
  const style = document.createElement("style");
  document.head.append(style);
  new URLSearchParams(location.hash.slice(1)).forEach((v, k) => { if (keys.includes(k)) state[k] = v; });
  ["vehicle", "verdict", "state"].forEach((k) => {
    options($(k), column(k));
    $(k).value = state[k];
    $(k).addEventListener("change", (e) => { state[k] = e.target.value; show(); keep(); });
  });
  $("q").value = state.q;
  $("q").addEventListener("input", (e) => { state.q = e.target.value; show(); keep(); });
  heads.forEach((th, i) => {
    if (i) {
      const label = document.createElement("label"), box = document.createElement("input");
      Object.assign(box, { type: "checkbox", value: title(th), checked: true });
      label.append(box, " " + title(th));
      $("columns").append(label);
      box.addEventListener("change", () => {
        state.hide = [...document.querySelectorAll("#columns input")].filter((b) => !b.checked).map((b) => b.value).join(",");
        columns(); keep();
      });
    }
    th.tabIndex = 0;
    const turn = () => {
      const numeric = !th.classList.contains("l"), first = numeric ? "down" : "up", other = numeric ? "up" : "down";
      state.sort = `${title(th)}:${state.sort === `${title(th)}:${first}` ? other : first}`;
      order(); keep();
    };
    th.addEventListener("click", turn);
    th.addEventListener("keydown", (e) => { if (e.key === "Enter" || e.key === " ") { e.preventDefault(); turn(); } });
  });
  columns(); order(); show();
  document.querySelector(".tools").hidden = false;
  requestAnimationFrame(() => setTimeout(() => table.classList.add("whole")));  // the page stands: now the rows below the first screens
})();
