// One quantity over time: estimate, 2-sigma band, truth. SPDX-License-Identifier: MIT

import { el, points, text } from "./draw.mjs";
import { HAS } from "./words.mjs";

const TICKS = [1, 2, 4, 5, 10, 20, 40, 100]; // m
const PAD = { left: 34, right: 6, top: 6, bottom: 16 };

/** Whether the width is that of the front edge (line, box); of other models it is the extent across the line of sight. */
export const isEdge = (r) => r.model === 3 || r.model === 4;

/** The four charts: value, 1 sigma and truth of a report; null while the value is unknown. */
export const QUANTITIES = [
  { id: "ahead", needs: HAS.position, of: (r) => [r.ahead_m, Math.sqrt(r.ahead_ahead_m2), r.true_ahead_m], span: [0, 460], tick: 200 },
  { id: "side", needs: HAS.position, of: (r) => [r.right_m, Math.sqrt(r.right_right_m2), r.true_right_m], about: 24, tick: 20 },
  { id: "width", needs: HAS.width, of: (r) => [r.width_m, r.width_sd_m, isEdge(r) ? r.true_width_m : r.true_width_in_view_m], upTo: 2.1 },
  { id: "height", needs: HAS.height, of: (r) => [r.height_m, r.height_sd_m, r.true_obstacle_height_m], upTo: 2 },
];

export function read(quantity, r) {
  return r.valid & quantity.needs ? quantity.of(r) : null;
}

function range(quantity, flight) {
  const truth = quantity.of(flight[flight.length - 1])[2];
  if (quantity.span) return [...quantity.span, quantity.tick];
  if (quantity.about) return [truth - quantity.about, truth + quantity.about, quantity.tick];
  const high = quantity.upTo * truth;
  return [0, high, TICKS.find((tick) => tick >= high / 3) ?? high];
}

/** The periods in which the quantity is known. */
function stretches(quantity, flight) {
  const found = [];
  let open = null;
  for (const r of flight) {
    const now = read(quantity, r);
    if (!now) {
      open = null;
      continue;
    }
    if (!open) found.push((open = []));
    open.push([r.time_s, ...now]);
  }
  return found.filter((stretch) => stretch.length > 1);
}

export function drawChart(svg, quantity, flight, at) {
  const width = svg.clientWidth, height = svg.clientHeight;
  if (width < 2 * PAD.left) return; // not laid out yet
  const last_s = flight[flight.length - 1].time_s;
  const [low, high, tick] = range(quantity, flight);
  const x = (s) => PAD.left + (s / last_s) * (width - PAD.left - PAD.right);
  const y = (v) => PAD.top + ((high - v) / (high - low)) * (height - PAD.top - PAD.bottom);
  let axis = "";
  for (let v = Math.ceil(low / tick) * tick; v <= high; v += tick) {
    axis += el("line", { class: "grid", x1: PAD.left, x2: width - PAD.right, y1: y(v), y2: y(v) });
    axis += text(PAD.left - 5, y(v) + 3.5, quantity.about && v ? `${Math.abs(v)} ${v < 0 ? "L" : "R"}` : String(v), { class: "note", "text-anchor": "end" });
  }
  for (let s = 0; s <= last_s; s += 5) axis += text(x(s), height - 3, s === 0 ? "0 s" : s, { class: "note", "text-anchor": "middle" });
  const found = stretches(quantity, flight);
  const known = found.map((list) => {
    const upper = list.map(([s, v, sd]) => [x(s), y(v + 2 * sd)]), lower = list.map(([s, v, sd]) => [x(s), y(v - 2 * sd)]);
    return el("polygon", { class: "band", points: points([...upper, ...lower.reverse()]) }) +
      el("polyline", { class: "estimate", points: points(list.map(([s, v]) => [x(s), y(v)])) });
  }).join("");
  const truth = found.map((list) => el("polyline", { class: "true-line", points: points(list.map(([s, , , v]) => [x(s), y(v)])) })).join("");
  const now = x(flight[at].time_s), id = `clip-${quantity.id}`;
  const inside = { x: PAD.left, y: PAD.top, height: height - PAD.top - PAD.bottom };
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  svg.innerHTML =
    el("clipPath", { id }, el("rect", { ...inside, width: width - PAD.left - PAD.right })) +
    el("clipPath", { id: `${id}-past` }, el("rect", { ...inside, width: Math.max(now - PAD.left, 0) })) +
    axis + el("g", { class: "future", "clip-path": `url(#${id})` }, known) +
    el("g", { "clip-path": `url(#${id}-past)` }, known) + el("g", { "clip-path": `url(#${id})` }, truth) +
    el("line", { class: "now", x1: now, x2: now, y1: PAD.top, y2: height - PAD.bottom });
}
