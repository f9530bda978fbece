// The camera image: horizon, obstacle, the detector's box. SPDX-License-Identifier: MIT

import { el, points, trueOutline } from "./draw.mjs";

const WIDTH = 1280, HEIGHT = 960, FOCAL = 914; // px, as in approach.h
const FAR = 4; // tangent of the largest angle to which the horizon is drawn

/** Pixel of a point ahead, right and below, for a rolled camera. */
function project(roll, ahead, right, below) {
  const c = Math.cos(roll), s = Math.sin(roll);
  return [WIDTH / 2 + (FOCAL * (c * right + s * below)) / ahead, HEIGHT / 2 + (FOCAL * (c * below - s * right)) / ahead];
}

function ground(roll) {
  return [project(roll, 1, -FAR, 0), project(roll, 1, FAR, 0), project(roll, 1, FAR, 4 * FAR), project(roll, 1, -FAR, 4 * FAR)];
}

/** Faces of the obstacle. */
function faces(r, roll) {
  const base = trueOutline(r);
  const at = ([ahead, right], up) => project(roll, ahead, right, r.true_height_m - up);
  const low = base.map((corner) => at(corner, 0)), high = base.map((corner) => at(corner, r.true_obstacle_height_m));
  const sides = base.map((_, i) => [low[i], low[(i + 1) % low.length], high[(i + 1) % low.length], high[i]]);
  return { sides, roof: high, away: r.true_height_m < r.true_obstacle_height_m };
}

export function drawCamera(svg, r) {
  const roll = (r.true_roll_deg * Math.PI) / 180;
  const { sides, roof, away } = faces(r, roll);
  svg.setAttribute("viewBox", `0 0 ${WIDTH} ${HEIGHT}`);
  svg.innerHTML =
    el("rect", { class: "sky", x: 0, y: 0, width: WIDTH, height: HEIGHT }) +
    el("polygon", { class: "ground", points: points(ground(roll)) }) +
    sides.map((side) => el("polygon", { class: "wall", points: points(side) })).join("") +
    (away ? "" : el("polygon", { class: "roof", points: points(roof) })) +
    (r.box_seen
      ? el("rect", {
        class: "box", id: "box", x: r.box_left_px, y: r.box_top_px,
        width: r.box_right_px - r.box_left_px, height: r.box_bottom_px - r.box_top_px,
      })
      : "");
}
