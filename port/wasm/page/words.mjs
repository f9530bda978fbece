// The words for a report. SPDX-License-Identifier: MIT

export const HAS = { position: 1, length: 2, height: 4, orientation: 8, center: 16, width: 32 };
export const ORDER = { nothing: 0, clear: 1, doubt: 2, goAround: 3, uncertain: 4 };

const REASONS = {
  convention: "the inputs contradict each other (axes, signs or mounting)",
  moves: "the obstacle seems to move",
  base: "the base corners are not on the ground",
  shape: "the obstacle is not round",
  late: "poses and images differ in time",
  noise: "errors larger than configured, or another shape",
  none: "the images contradict the settings",
};

const STATUS = {
  converging: ["Collecting images", "One image contains no range: goe compares images from several positions."],
  no_baseline: ["Collecting images", "The camera has moved too little for a range."],
  no_parallax: ["Collecting images", "The obstacle has not grown enough in the image for a range."],
  no_detection: ["No detection", "The detector reports no obstacle."],
  box_incomplete: ["No estimate", "Only a part of the box is in the image."],
  no_height: ["No estimate", "The height above ground is unknown."],
};

/** Meters or degrees as one reads them: 3.2, 18, 182. */
export function amount(value) {
  const size = Math.abs(value);
  const text = size.toFixed(size < 9.95 ? 1 : 0);
  return value < 0 && Number(text) !== 0 ? `−${text}` : text;
}

/** Position relative to the course: "18 m left". */
export function side(value_m) {
  return Math.abs(value_m) < 0.05 ? "on the course" : `${amount(Math.abs(value_m))} m ${value_m < 0 ? "left" : "right"}`;
}

/** "Closest approach in 8 s: 3.0 ± 0.4 m to the side". */
function closest(r) {
  const when = r.tcpa_s > 0 ? `in ${Math.round(r.tcpa_s)} s` : "now";
  if (r.has_clearance && r.clearance_m > 0 && r.dcpa_m < 15) {
    return `Closest approach ${when}: ${amount(r.clearance_m)} ± ${amount(r.clearance_sd_m)} m above the top`;
  }
  return r.dcpa_m > 0
    ? `Closest approach ${when}: ${amount(r.dcpa_m)} ± ${amount(r.dcpa_sd_m)} m to the side`
    : `Course leads through the obstacle ${when}`;
}

/** Why the estimate is suspect, how old it is; empty if neither. */
export function doubts(r) {
  const found = [];
  if (r.suspect) found.push(`Suspect: ${REASONS[r.reason] ?? r.reason}. Margins are wider.`);
  if (r.valid && r.age_s > 0.25) found.push(`Predicted: last measured ${r.age_s.toFixed(1)} s ago.`);
  return found.join(" ");
}

/** Why there is no estimate yet. `first_s`: time of the flight's first estimate, null if there is none. */
function waiting(r, first_s) {
  const [head, line] = STATUS[r.status] ?? ["No estimate", `Status: ${r.status.replaceAll("_", " ")}.`];
  const left_s = first_s === null ? 0 : first_s - r.time_s;
  return { name: "nothing", head, line: left_s > 0 ? `${line} First estimate in ${left_s.toFixed(1)} s.` : line };
}

/** Name, headline and line of the decision. */
export function order(r, first_s) {
  switch (r.order) {
    case ORDER.goAround:
      return { name: "go-around", head: "Go around", line: `${closest(r)}.` };
    case ORDER.doubt:
      return { name: "doubt", head: "Keep observing", line: `${closest(r)}. Perhaps too close; there is time to measure longer.` };
    case ORDER.uncertain:
      return { name: "doubt", head: "Keep observing", line: `${closest(r)}. Too uncertain for a decision.` };
    case ORDER.clear:
      return { name: "clear", head: "Clear", line: `${closest(r)}.` };
    default:
      return waiting(r, first_s);
  }
}
