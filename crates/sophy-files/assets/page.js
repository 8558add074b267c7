"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const host = document.getElementById("plots");
  const plots = [];
  const MOST_LINES = 400; // more marks than this in view are not drawn
  const MOST_SHADES = 300; // as for the colours behind the curves
  const LEFT = 76, RIGHT = 16;
  const ink = "#222", grid = { stroke: "rgba(0,0,0,0.1)", width: 0.6 };
  const ratio = () => window.devicePixelRatio || 1;

  // First position whose value is greater than `x`.
  const after = (values, x) => {
    let low = 0, high = values.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (values[middle] <= x) low = middle + 1; else high = middle;
    }
    return low;
  };

  // Paints the locations of `band` in view; `wide` gets each span's edges in pixels.
  const spans = (u, band, paint) => {
    const { min, max } = u.scales.x;
    const first = Math.max(after(band.starts, min) - 1, 0);
    const last = after(band.starts, max);
    for (let i = first; i < last; i++) {
      const from = Math.max(u.valToPos(Math.max(band.starts[i], min), "x", true), u.bbox.left);
      const end = i + 1 < band.starts.length ? band.starts[i + 1] : max;
      const to = Math.min(u.valToPos(Math.min(end, max), "x", true), u.bbox.left + u.bbox.width);
      if (to > from) paint(band.locations[i], from, to);
    }
    return last - first;
  };

  const shade = u => {
    const band = data.bands.find(band => band.behind);
    if (!band) return;
    const { min, max } = u.scales.x;
    if (after(band.starts, max) - after(band.starts, min) > MOST_SHADES) return;
    spans(u, band, (location, from, to) => {
      u.ctx.fillStyle = band.shades[location];
      u.ctx.fillRect(from, u.bbox.top, to - from, u.bbox.height);
    });
  };

  const marks = u => {
    const { min, max } = u.scales.x;
    const first = after(data.marks, min), last = after(data.marks, max);
    if (last - first > MOST_LINES) return;
    u.ctx.save();
    u.ctx.strokeStyle = "rgba(0,0,0,0.28)";
    u.ctx.lineWidth = 0.6 * ratio();
    u.ctx.beginPath();
    for (let i = first; i < last; i++) {
      const x = u.valToPos(data.marks[i], "x", true);
      u.ctx.moveTo(x, u.bbox.top);
      u.ctx.lineTo(x, u.bbox.top + u.bbox.height);
    }
    u.ctx.stroke();
    u.ctx.restore();
  };

  // A line that breaks at jumps (two rows of one time) and at missing values.
  const broken = (u, series, from, to) => {
    const stroke = new Path2D();
    const times = u.data[0], values = u.data[series], scale = u.series[series].scale;
    let drawing = false;
    for (let i = from; i <= to; i++) {
      if (values[i] === null || values[i] === undefined) { drawing = false; continue; }
      const x = u.valToPos(times[i], "x", true), y = u.valToPos(values[i], scale, true);
      const jump = drawing && times[i] === times[i - 1] && values[i] !== values[i - 1];
      if (drawing && !jump) stroke.lineTo(x, y); else stroke.moveTo(x, y);
      const alone = !drawing && (i === to || values[i + 1] === null);
      if (alone) stroke.arc(x, y, ratio(), 0, 7);
      drawing = true;
    }
    return { stroke, fill: null, clip: null, band: null, gaps: null, flags: 1 };
  };

  let zooming = false;
  const follow = (u, key) => {
    if (key !== "x" || zooming) return;
    zooming = true;
    const { min, max } = u.scales.x;
    for (const other of plots) if (other !== u) other.setScale("x", { min, max });
    zooming = false;
  };

  // As many digits as tell neighbouring ticks apart.
  const tickLabels = (u, ticks, axis, space, step) => {
    const order = x => Math.floor(Math.log10(Math.abs(x)) + 1e-9);
    // The place of the last digit of the step: 0 for 5, -1 for 2.5, -2 for 0.25.
    const [digits, power] = step.toExponential(5).split("e");
    const place = Number(power) - digits.replace(/0+$/, "").length + 2;
    const largest = Math.max(...ticks.map(Math.abs));
    const plain = largest === 0 || (largest < (place > 3 ? 1e7 : 1e15) && largest >= 1e-2);
    const label = v => plain ? v.toFixed(Math.max(0, -place)) : v === 0 ? "0" : v.toExponential(Math.max(0, order(v) - place));
    // Late digits alone when all do not fit; the values under the curves are whole.
    const short = text => text.length > 8 ? "\u2026" + text.slice(-6) : text;
    return ticks.map(v => short(label(v).replace("e+", "e").replace(/-/g, "\u2212")));
  };

  const width = () => Math.max(320, host.clientWidth);
  const number = value => value === null || value === undefined ? "–" : String(Number(value.toPrecision(7)));
  const first = data.time[0], final = data.time[data.time.length - 1];
  const whole = final > first ? [first, final] : [(first ?? 0.5) - 0.5, (first ?? 0.5) + 0.5];
  const common = height => ({
    width: width(),
    height,
    padding: [8, RIGHT, 0, 0],
    cursor: { y: false, sync: { key: "run" }, drag: { x: true, y: false } },
  });
  const xScale = { time: false, range: (u, min, max) => min === null || max <= min ? whole : [min, max] };
  const xAxis = last => ({
    stroke: ink, grid, ticks: { stroke: ink, width: 0.8, size: 4 }, font: "12px Roboto, Helvetica, Arial, sans-serif",
    values: last ? tickLabels : () => [],
    label: last ? "time (s)" : undefined, labelSize: 18, labelFont: "12px Roboto, Helvetica, Arial, sans-serif",
    size: last ? 28 : 6, gap: 3,
  });

  const items = data.panels.length + data.bands.length;
  const tall = Math.max(130, Math.min(300, Math.round(620 / Math.max(1, data.panels.length))));
  data.panels.forEach((panel, index) => {
    const last = index + 1 === items;
    const yRange = (u, min, max) => {
      if (min === null) return [-1.2, 1.2];
      const span = max - min, size = Math.max(Math.abs(min), Math.abs(max));
      if (span > 1e-11 * size) return [min - 0.05 * span, max + 0.05 * span];
      return size > 0 ? [min - 0.12 * size, max + 0.12 * size] : [-1.2, 1.2];
    };
    plots.push(new uPlot({
      ...common(tall + (last ? 46 : 0)),
      scales: { x: xScale, y: { range: yRange } },
      axes: [xAxis(last), {
        stroke: ink, grid, ticks: { stroke: ink, width: 0.8, size: 4 }, font: "12px Roboto, Helvetica, Arial, sans-serif",
        label: panel.title, labelSize: 20, labelFont: "12px Roboto, Helvetica, Arial, sans-serif", size: LEFT - 20, gap: 3, values: tickLabels,
      }],
      series: [{ label: "time", value: (u, v) => v === null ? "–" : number(v) + " s" }].concat(panel.curves.map(curve => ({
        label: curve.name, stroke: curve.colour, width: 1.4, points: { show: false }, paths: broken,
        dash: curve.dashes ? curve.dashes.split(" ").map(Number) : undefined,
        value: (u, v) => v === null ? "–" : number(v) + (panel.unit ? " " + panel.unit : ""),
      }))),
      hooks: { drawClear: [shade], drawAxes: [marks], setScale: [follow] },
    }, [data.time].concat(panel.curves.map(curve => curve.values)), host));
  });

  data.bands.forEach((band, index) => {
    const last = data.panels.length + index + 1 === items;
    const at = data.time.map(time => band.locations[Math.max(after(band.starts, time) - 1, 0)]);
    const paint = u => {
      u.ctx.save();
      u.ctx.font = 11 * ratio() + "px Roboto, Helvetica, Arial, sans-serif";
      u.ctx.textBaseline = "middle";
      u.ctx.textAlign = "right";
      u.ctx.fillStyle = ink;
      let name = band.name;
      while (name.length > 3 && u.ctx.measureText(name).width > u.bbox.left - 10 * ratio()) name = "\u2026" + name.slice(2);
      u.ctx.fillText(name, u.bbox.left - 7 * ratio(), u.bbox.top + u.bbox.height / 2);
      u.ctx.textAlign = "center";
      spans(u, band, (location, from, to) => {
        u.ctx.fillStyle = band.colours[location];
        u.ctx.fillRect(from, u.bbox.top, to - from, u.bbox.height);
        const name = band.names[location];
        if (u.ctx.measureText(name).width + 6 * ratio() < to - from) {
          u.ctx.fillStyle = ink;
          u.ctx.fillText(name, (from + to) / 2, u.bbox.top + u.bbox.height / 2);
        }
      });
      u.ctx.restore();
    };
    plots.push(new uPlot({
      ...common(34 + (last ? 46 : 0)),
      scales: { x: xScale, y: { range: [0, 1] } },
      axes: [xAxis(last), { size: LEFT, values: () => [], grid: { show: false }, ticks: { show: false } }],
      series: [{ label: "time", value: (u, v) => v === null ? "–" : number(v) + " s" }, {
        label: band.name, paths: () => null, points: { show: false }, value: (u, v) => v === null ? "–" : band.names[v],
      }],
      hooks: { drawAxes: [paint], setScale: [follow] },
    }, [data.time, at], host));
    const key = document.createElement("div");
    key.className = "key";
    for (const location of [...new Set(band.locations)].sort((a, b) => a - b)) {
      const item = document.createElement("span"), box = document.createElement("i");
      box.style.background = band.colours[location];
      item.append(box, band.names[location]);
      key.append(item);
    }
    host.append(key);
  });

  window.addEventListener("resize", () => plots.forEach(u => u.setSize({ width: width(), height: u.height })));

  if (data.events.length) {
    const details = document.getElementById("events");
    const more = data.events_in_all > data.events.length ? ", the first " + data.events.length + " of them here" : "";
    details.querySelector("summary").textContent = "Transitions (" + data.events_in_all + more + ")";
    const body = details.querySelector("tbody");
    for (const event of data.events) {
      const row = body.insertRow();
      for (const text of [event.time, event.component, event.transition, event.from, event.to]) {
        row.insertCell().textContent = text;
      }
    }
    details.hidden = false;
  }
  if (!document.querySelector("#about td")) document.getElementById("about").hidden = true;

  const tabs = [["over-time", "time-view"], ["in-phase", "phase-view"]];
  for (const [button] of tabs) {
    document.getElementById(button)?.addEventListener("click", () => {
      for (const [b, view] of tabs) {
        document.getElementById(b).classList.toggle("on", b === button);
        document.getElementById(view).hidden = b !== button;
      }
    });
  }
})();
