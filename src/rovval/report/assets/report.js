"use strict";
(() => {
  const D = JSON.parse(document.getElementById("data").textContent);
  const { css, values: unpack, offer } = saving;
  const X = {}, hidden = new Set(D.hidden || []);
  for (const key in D.x) X[key] = unpack(D.x[key]);
  // A tube is what lies within a tolerance of the first curve: its two edges are curves without a line.
  const edges = (p) => (p.tube ? [1, -1].map((k) => p.data[1].map((v) => (v === null ? null : v + k * p.tube))) : []);
  const less = (a, b) => a.map((v, i) => (v === null || b[i] === null ? null : v - b[i]));
  const other = (s) => D.plots.find((p) => p.id === s.of).series, values = (s) => (s.d ? unpack(s.d) : less(values(other(s)[s.index]), values(other(s)[0])));
  const plots = D.plots.map((p) => ({ ...p, data: [X[p.x], ...p.series.map(values)] }));
  const colour = (s) => (s.hue === undefined ? css("--" + s.key) : `hsl(${s.hue} 55% ${css("--bg") === "#fff" ? 42 : 66}%)`);
  const short = (v) => (v === null || v === undefined ? "–" : v.toPrecision(3));
  // An error strip is low: zero, and the largest round number that fits in on both sides.
  const ticks = (u) => {
    const { min, max } = u.scales.y, far = Math.max(Math.abs(min), Math.abs(max)), power = 10 ** Math.floor(Math.log10(far || 1));
    const round = [5, 4, 3, 2, 1.5, 1].map((k) => k * power).find((v) => v <= far) || far;
    return [-round, 0, round].filter((v) => v >= min && v <= max);
  };
  const decades = (v, unit) => v.map((t) => (t === null || Math.abs(Math.log10(t) % 1) > 1e-9 ? "" : t === 1 ? `${t} ${unit}` : t));
  const shade = (u, bands) => {
    const { left, top, width, height } = u.bbox, place = (v) => Math.min(Math.max(u.valToPos(v, "x", true), left), left + width);
    for (const [from, to, key] of bands) {
      u.ctx.fillStyle = css("--" + key);
      u.ctx.fillRect(place(from), top, Math.max(place(to) - place(from), from === to ? 2 * devicePixelRatio : 0), height);
    }
  };
  let charts = [], moving = false;

  const draw = () => {
    charts.forEach((u) => u.destroy());
    const fg = css("--muted"), grid = css("--grid");
    const axis = { stroke: fg, font: "11px system-ui, sans-serif", grid: { stroke: grid, width: 1 }, ticks: { show: false } };
    charts = plots.map((p) => {
      const host = document.getElementById(p.id), read = p.error ? null : host.parentNode.querySelector(".read");
      const { unit = "s", log = false } = D.x[p.x], tube = edges(p), first = p.series.length + 1;
      const series = p.series.map((s) => ({
        label: s.label, stroke: colour(s), width: s.key === "measured" ? 2.2 : s.key === "free" ? 1 : 1.3, dash: s.dash, points: { show: false }, show: !hidden.has(s.key),
        spanGaps: false,
      }));
      return new uPlot({
        width: host.clientWidth, height: host.clientHeight, legend: { show: false }, padding: [8, 6, p.bare ? 8 : 0, 0],
        cursor: { sync: { key: p.x, setSeries: false }, drag: { x: true, y: false }, points: { size: 5 }, y: false },
        scales: { x: { time: false, distr: log ? 3 : 1, ...(log ? { range: (u, min, max) => [min, max] } : {}) } },
        axes: [{ ...axis, show: !p.bare, size: 26, values: (u, v) => (log ? decades(v, unit) : v.map((t, i) => (i === v.length - 1 ? `${t} ${unit}` : t))) },
          { ...axis, size: 50, space: host.clientHeight < 150 ? 20 : 30, ...(p.error ? { splits: ticks } : {}) }],
        series: [{}, ...series, ...tube.map(() => ({ points: { show: false } }))],
        bands: tube.length ? [{ series: [first, first + 1], fill: css("--tube") }] : [],
        hooks: {
          drawClear: [(u) => shade(u, p.bands || [])],
          setCursor: [(u) => {
            const k = u.cursor.idx;
            if (!read) return;
            read.textContent = k === null || k === undefined ? "" :
              `${log ? short(u.data[0][k]) : u.data[0][k].toFixed(1)} ${unit}  ` + p.series.map((s, i) => (u.series[i + 1].show && p.series.length < 5 ? `${s.short || s.label} ${short(u.data[i + 1][k])}` : "")).filter(Boolean).join("  ");
          }],
          setScale: [(u, k) => {
            if (k !== "x" || moving) return;
            moving = true;
            charts.forEach((v, j) => { if (v !== u && plots[j].x === p.x) v.setScale("x", { min: u.scales.x.min, max: u.scales.x.max }); });
            moving = false;
          }],
        },
      }, [...p.data, ...tube], host);
    });
  };

  // Every picture as a file: a picture is one canvas, or two below each other, under its heading.
  const parts = (box) => [...box.querySelectorAll(".canvas")].map((host) => plots.findIndex((p) => p.id === host.id));
  const sheet = (box) => {
    const pictures = parts(box).map((k) => charts[k].ctx.canvas), scale = devicePixelRatio, head = 24 * scale;
    const whole = Object.assign(document.createElement("canvas"), { width: pictures[0].width, height: head + pictures.reduce((sum, c) => sum + c.height, 0) });
    const pen = whole.getContext("2d");
    pen.fillStyle = css("--bg");
    pen.fillRect(0, 0, whole.width, whole.height);
    pen.fillStyle = css("--ink");
    pen.font = `${12 * scale}px system-ui, sans-serif`;
    pen.fillText([...box.querySelectorAll("header > b, header > span")].map((e) => e.textContent).filter(Boolean).join("   "), 6 * scale, 16 * scale);
    pictures.reduce((top, c) => { pen.drawImage(c, 0, top); return top + c.height; }, head);
    return whole;
  };
  const columns = (box) => {
    const shown = parts(box).map((k) => plots[k]), { unit = "s" } = D.x[shown[0].x];
    const named = shown.flatMap((p) => p.series.map((s, i) => [s.label + (p.error ? ", error" : ""), p.data[i + 1]]));
    return [[unit === "s" ? "time_s" : unit, X[shown[0].x]], ...named];
  };
  document.querySelectorAll(".plot").forEach((box) => {
    const read = box.querySelector(".read"), line = Object.assign(document.createElement("div"), { className: "line" });
    read.replaceWith(line);
    line.append(read, offer(box.querySelector("header b").textContent, box.querySelector(".canvas").id, () => sheet(box), () => columns(box)));
  });

  document.querySelectorAll(".keys button").forEach((b) => {
    const key = b.dataset.key, set = () => b.setAttribute("aria-pressed", String(!hidden.has(key)));
    set();
    b.addEventListener("click", () => {
      if (hidden.has(key)) hidden.delete(key); else hidden.add(key);
      set();
      charts.forEach((u, j) => plots[j].series.forEach((s, i) => { if (s.key === key) u.setSeries(i + 1, { show: !hidden.has(key) }); }));
    });
  });
  // What the mouse does, by keys: arrows move the reading, + and - zoom round it, 0 shows all.
  plots.forEach((p, j) => {
    if (p.error) return;
    const host = document.getElementById(p.id), title = host.parentNode.querySelector("header b").textContent;
    Object.assign(host, { tabIndex: 0 }).setAttribute("role", "group");
    host.setAttribute("aria-label", `${title}: arrows read values, plus and minus zoom, 0 shows all`);
    host.addEventListener("keydown", (e) => {
      const u = charts[j], x = u.data[0], wide = u.bbox.width / devicePixelRatio, { min, max } = u.scales.x, at = u.cursor.left < 0 ? wide / 2 : u.cursor.left;
      const read = (step) => u.setCursor({ left: Math.min(Math.max(at + step, 0), wide), top: 1 });
      const zoom = (by, mid = u.posToVal(at, "x")) => u.setScale("x", { min: Math.max(x[0], mid - by * (mid - min)), max: Math.min(x[x.length - 1], mid + by * (max - mid)) });
      const keys = { ArrowLeft: () => read(-4), ArrowRight: () => read(4), "+": () => zoom(0.5), "=": () => zoom(0.5), "-": () => zoom(2), 0: () => u.setScale("x", { min: x[0], max: x[x.length - 1] }) };
      if (e.ctrlKey || e.metaKey || e.altKey || !keys[e.key]) return;
      e.preventDefault();
      keys[e.key]();
    });
  });
  let wait = 0;
  addEventListener("resize", () => {
    clearTimeout(wait);
    wait = setTimeout(() => fit(matchMedia("print").matches), 80);
  });
  // A sheet of A4 or letter holds two pictures side by side, of 690 pixels in all.
  const fit = (paper) => charts.forEach((u, j) => {
    const host = document.getElementById(plots[j].id);
    u.setSize({ width: !paper ? host.clientWidth : host.closest(".wide") ? 690 : 335, height: host.clientHeight });
  });
  addEventListener("beforeprint", () => fit(true));
  addEventListener("afterprint", () => fit(false));
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", draw);
  draw();
})();
