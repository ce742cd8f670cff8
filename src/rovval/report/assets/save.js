"use strict";
// Every picture as a file: PNG as it is seen, and CSV with all of its values. Drawings offer both here, the curves of the page in report.js.
const saving = (() => {
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const decode = (e) => {
    const s = atob(e.b), n = s.length / 2, out = new Array(n), k = (e.hi - e.lo) / 65534;
    for (let i = 0; i < n; i++) {
      const q = s.charCodeAt(2 * i) | (s.charCodeAt(2 * i + 1) << 8);
      out[i] = q === 65535 ? null : e.lo + q * k;
    }
    return out;
  };
  const values = (c) => c.v || (c.b ? decode(c) : Array.from({ length: c.n }, (_, i) => c.t0 + i * c.dt));
  const keep = (name, kind, url) => {
    const whole = `${document.querySelector("h1").textContent} ${name}.${kind}`.replace(/[^\w.-]+/g, "_");
    Object.assign(document.createElement("a"), { download: whole, href: url }).click();
  };
  const cell = (v, digits) => (v === null || v === undefined ? "" : typeof v === "number" ? String(+v.toPrecision(digits)) : /[",\n]/.test(v) ? `"${v.replaceAll('"', '""')}"` : v);
  const table = (columns) => {
    const heads = columns.map(([head]) => head), all = columns.map(([, column]) => column), rows = Math.max(0, ...all.map((c) => c.length));
    const lines = Array.from({ length: rows }, (_, i) => all.map((c, j) => cell(c[i], j ? 6 : 9)).join(","));
    return [heads.map(cell).join(","), ...lines, ""].join("\n");
  };
  // Two buttons for the picture `title`, in files of `name`: `sheet` gives its canvas, or the promise of it, and `columns` its values with their headings.
  const offer = (title, name, sheet, columns) => {
    const bar = Object.assign(document.createElement("span"), { className: "save" });
    const png = async () => keep(name, "png", (await sheet()).toDataURL("image/png"));
    const csv = () => keep(name, "csv", URL.createObjectURL(new Blob([table(columns())], { type: "text/csv" })));
    [["PNG", png], ["CSV", csv]].forEach(([label, write]) => {
      const button = Object.assign(document.createElement("button"), { type: "button", textContent: label, title: `Save this picture as ${label}` });
      button.setAttribute("aria-label", `${title}: save as ${label}`);
      button.addEventListener("click", write);
      bar.append(button);
    });
    return bar;
  };
  // A drawing on its own: colours and letters of the page's style sheet go with each of its shapes.
  const STYLES = ["fill", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin", "opacity", "paint-order", "font-family", "font-size", "font-weight"];
  const sheet = async (svg) => {
    const copy = svg.cloneNode(true), from = [svg, ...svg.querySelectorAll("*")], to = [copy, ...copy.querySelectorAll("*")];
    from.forEach((shape, k) => { const style = getComputedStyle(shape); STYLES.forEach((s) => to[k].style.setProperty(s, style.getPropertyValue(s))); });
    const { width, height } = svg.viewBox.baseVal, scale = 2 * devicePixelRatio, edge = 8 * scale;
    Object.entries({ width: width * scale, height: height * scale, xmlns: "http://www.w3.org/2000/svg" }).forEach(([k, v]) => copy.setAttribute(k, v));
    const image = new Image();
    image.src = "data:image/svg+xml;charset=utf-8," + encodeURIComponent(new XMLSerializer().serializeToString(copy));
    await image.decode();
    const canvas = Object.assign(document.createElement("canvas"), { width: width * scale + 2 * edge, height: height * scale + 2 * edge }), pen = canvas.getContext("2d");
    pen.fillStyle = css("--bg");
    pen.fillRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(image, edge, edge);
    return canvas;
  };
  document.querySelectorAll("figure.drawn").forEach((figure) => {
    const svg = figure.querySelector("svg"), title = svg.getAttribute("aria-label");
    const columns = () => JSON.parse(figure.querySelector("script").textContent).map(([head, column]) => [head, values(column)]);
    figure.append(offer(title, title.slice(0, 60), () => sheet(svg), columns));
  });
  return { css, values, offer };
})();
