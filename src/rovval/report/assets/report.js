"use strict";
(() => {
  const D = JSON.parse(document.getElementById("data").textContent);
  const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const decode = (e) => {
    const s = atob(e.b), n = s.length / 2, out = new Array(n), k = (e.hi - e.lo) / 65534;
    for (let i = 0; i < n; i++) {
      const q = s.charCodeAt(2 * i) | (s.charCodeAt(2 * i + 1) << 8);
      out[i] = q === 65535 ? null : e.lo + q * k;
    }
    return out;
  };
  const times = (x) => (x.b ? decode(x) : Array.from({ length: x.n }, (_, i) => x.t0 + i * x.dt));
  const X = {}, hidden = new Set(D.hidden || []);
  for (const key in D.x) X[key] = times(D.x[key]);
  const plots = D.plots.map((p) => ({ ...p, data: [X[p.x], ...p.series.map((s) => decode(s.d))] }));
  const colour = (s, i, n) => (s.hue === undefined ? css("--" + s.key) : `hsl(${s.hue} 55% ${css("--bg") === "#fff" ? 42 : 66}%)`);
  const short = (v) => (v === null || v === undefined ? "–" : v.toPrecision(3));
  // An error strip is low: zero, and the largest round number that fits in on both sides.
  const ticks = (u) => {
    const { min, max } = u.scales.y, far = Math.max(Math.abs(min), Math.abs(max)), power = 10 ** Math.floor(Math.log10(far || 1));
    const round = [5, 4, 3, 2, 1.5, 1].map((k) => k * power).find((v) => v <= far) || far;
    return [-round, 0, round].filter((v) => v >= min && v <= max);
  };
  let charts = [], moving = false;

  const draw = () => {
    charts.forEach((u) => u.destroy());
    const fg = css("--muted"), grid = css("--grid");
    const axis = { stroke: fg, font: "11px system-ui, sans-serif", grid: { stroke: grid, width: 1 }, ticks: { show: false } };
    charts = plots.map((p) => {
      const host = document.getElementById(p.id), read = p.error ? null : host.parentNode.querySelector(".read");
      const series = p.series.map((s, i) => ({
        label: s.label, stroke: colour(s, i), width: s.key === "measured" ? 2.2 : s.key === "free" ? 1 : 1.3, dash: s.dash, points: { show: false }, show: !hidden.has(s.key),
        spanGaps: false,
      }));
      return new uPlot({
        width: host.clientWidth, height: host.clientHeight, legend: { show: false }, padding: [8, 6, p.bare ? 8 : 0, 0],
        cursor: { sync: { key: p.x, setSeries: false }, drag: { x: true, y: false }, points: { size: 5 }, y: false },
        scales: { x: { time: false } },
        axes: [{ ...axis, show: !p.bare, size: 26, values: (u, v) => v.map((t, i) => (i === v.length - 1 ? t + " s" : t)) },
          { ...axis, size: 50, space: 30, ...(p.error ? { splits: ticks } : {}) }],
        series: [{}, ...series],
        hooks: {
          setCursor: [(u) => {
            const k = u.cursor.idx;
            if (!read) return;
            read.textContent = k === null || k === undefined ? "" :
              `${u.data[0][k].toFixed(1)} s  ` + p.series.map((s, i) => (u.series[i + 1].show && p.series.length < 5 ? `${s.short || s.label} ${short(u.data[i + 1][k])}` : "")).filter(Boolean).join("  ");
          }],
          setScale: [(u, k) => {
            if (k !== "x" || moving) return;
            moving = true;
            charts.forEach((v, j) => { if (v !== u && plots[j].x === p.x) v.setScale("x", { min: u.scales.x.min, max: u.scales.x.max }); });
            moving = false;
          }],
        },
      }, p.data, host);
    });
  };

  document.querySelectorAll(".keys button").forEach((b) => {
    const key = b.dataset.key, set = () => b.setAttribute("aria-pressed", String(!hidden.has(key)));
    set();
    b.addEventListener("click", () => {
      if (hidden.has(key)) hidden.delete(key); else hidden.add(key);
      set();
      charts.forEach((u, j) => plots[j].series.forEach((s, i) => { if (s.key === key) u.setSeries(i + 1, { show: !hidden.has(key) }); }));
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
