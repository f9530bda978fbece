// The approach from above, flight direction to the right. SPDX-License-Identifier: MIT

import { el, ellipse, outline, points, text, trueOutline } from "./draw.mjs";
import { HAS, ORDER } from "./words.mjs";

const BEHIND_M = 12, BEYOND_M = 62; // least extent behind the aircraft's start and beyond the obstacle
const ASIDE_M = 56; // ... and on either side
const MARGIN_M = 15; // as in live.c
const NAMES_PX = 18; // height of the labels of the lines
const FIELD_DEG = 35; // half the camera's field of view
const NARROW_PX = 560; // a narrower map follows the aircraft

/** Meters on the ground to pixels of the map. */
function plane(width, height, r, first_m) {
  const here_m = first_m - r.true_ahead_m;
  const left_m = width < NARROW_PX ? here_m - BEHIND_M : -BEHIND_M;
  const scale = Math.min(width / (first_m + BEYOND_M - left_m), (height - NAMES_PX) / (2 * ASIDE_M));
  return { scale, x: (north) => (north - left_m) * scale, y: (east) => 0.5 * (height - NAMES_PX) + east * scale, here_m };
}

/** A line for every 100 m of distance to the obstacle, drawn first, and their labels, drawn last. */
function grid(p, height, first_m) {
  let lines = "", names = "";
  for (let left_m = 0; left_m <= first_m; left_m += 100) {
    const x = p.x(first_m - left_m);
    if (x < 0) continue;
    lines += el("line", { class: "grid", x1: x, x2: x, y1: 0, y2: height - NAMES_PX });
    const name = left_m === 0 ? "abeam" : `${left_m} m`;
    names += text(x, height - 5, name, { class: "note", "text-anchor": x < 24 ? "start" : "middle" });
  }
  return { lines, names };
}

function course(p, width, r) {
  const band = MARGIN_M * p.scale;
  const reach = Math.min(0.5 * r.true_ahead_m, 60) * p.scale;
  const half = reach * Math.tan((FIELD_DEG * Math.PI) / 180);
  const x = p.x(p.here_m), y = p.y(0);
  return (
    el("rect", { class: r.order === ORDER.goAround ? "corridor hot" : "corridor", x: 0, width, y: y - band, height: 2 * band }) +
    el("polygon", { class: "field", points: points([[x, y], [x + reach, y - half], [x + reach, y + half]]) }) +
    el("line", { class: "planned", x1: x, x2: width, y1: y, y2: y }) +
    el("line", { class: "flown", x1: p.x(0), x2: x, y1: y, y2: y })
  );
}

function aircraft(p) {
  const glyph = [[14, 0], [4, 2.5], [2, 13], [-2, 13], [-1, 2.5], [-8, 2], [-9.5, 6], [-11.5, 6], [-11, 0]];
  const both = [...glyph, ...glyph.slice().reverse().map(([x, y]) => [x, -y])];
  return el("polygon", { class: "aircraft", points: points(both.map(([x, y]) => [p.x(p.here_m) + x, p.y(0) + y])) });
}

/** The true obstacle, the estimate on top of it. */
function obstacle(p, r) {
  const place = ([ahead, right]) => [p.x(p.here_m + ahead), p.y(right)];
  let found = el("polygon", { class: "truth", points: points(trueOutline(r).map(place)) });
  if (!(r.valid & HAS.position)) return found;
  const middle = place([r.ahead_m, r.right_m]);
  const e = ellipse(r.ahead_ahead_m2, r.ahead_right_m2, r.right_right_m2, 2);
  const turn = `rotate(${((e.angle * 180) / Math.PI).toFixed(2)} ${middle[0].toFixed(2)} ${middle[1].toFixed(2)})`;
  found += el("ellipse", {
    class: "region", id: "region", cx: middle[0], cy: middle[1], rx: e.long * p.scale, ry: Math.max(e.short * p.scale, 1),
    transform: turn,
  });
  const known = r.valid & HAS.length && r.along_north ** 2 + r.along_east ** 2 > 0.5;
  if (r.valid & HAS.width) {
    const shape = outline([r.ahead_m, r.right_m], r.width_m, r.length_m,
      known ? [r.across_north, r.across_east] : null, [r.along_north, r.along_east]);
    found += el("polygon", { class: "estimate", id: "outline", points: points(shape.map(place)) });
  }
  return found + el("path", { class: "middle", d: `M${middle[0] - 5} ${middle[1]}h10M${middle[0]} ${middle[1] - 5}v10` });
}

/** The place of closest approach. */
function closest(p, r, speed_m_s) {
  if (!(r.order > ORDER.nothing) || r.tcpa_s <= 0) return "";
  const x = p.x(p.here_m + r.tcpa_s * speed_m_s);
  return el("path", { class: r.order === ORDER.goAround ? "closest hot" : "closest", d: `M${x} ${p.y(0) - 9}v18` });
}

/** Draws the report number `at` of a flight into an svg of this size in pixels. */
export function drawMap(svg, flight, at) {
  const width = svg.clientWidth, height = svg.clientHeight;
  if (width === 0) return; // not laid out yet
  const r = flight[at], first_m = flight[0].true_ahead_m;
  const speed_m_s = (flight[1].true_north_m - flight[0].true_north_m) / (flight[1].time_s - flight[0].time_s);
  const p = plane(width, height, r, first_m);
  svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
  const { lines, names } = grid(p, height, first_m);
  svg.innerHTML = lines + course(p, width, r) + obstacle(p, r) + closest(p, r, speed_m_s) + aircraft(p) + names;
}
