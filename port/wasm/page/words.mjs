// What a report says to a pilot. SPDX-License-Identifier: MIT

export const HAS = { position: 1, length: 2, height: 4, orientation: 8, center: 16, width: 32 };
export const ORDER = { nothing: 0, clear: 1, doubt: 2, goAround: 3, uncertain: 4 };

const REASONS = {
  convention: "the inputs contradict each other",
  moves: "the obstacle seems to move",
  base: "the base corners are wrong",
  shape: "its shape is not that of a disc",
  late: "the poses come late against the images",
  noise: "the errors are larger than configured, or the shape is another",
  none: "the images do not fit the settings",
};

const STATUS = {
  collecting: "collecting images",
  nothing_seen: "no detection",
  box_incomplete: "only a part of the box is visible",
  no_height: "the height above ground is not set",
};

/** Meters or degrees, rounded for reading: 3.2, 18, 182. */
export function amount(value) {
  const size = Math.abs(value);
  const text = size.toFixed(size < 9.95 ? 1 : 0);
  return value < 0 && Number(text) !== 0 ? `−${text}` : text;
}

/** Position relative to the track: "18 m left". */
export function side(value_m) {
  return Math.abs(value_m) < 0.05 ? "on the track" : `${amount(Math.abs(value_m))} m ${value_m < 0 ? "left" : "right"}`;
}

/** How the flight will pass, after "in 8 s": "3.0 m past it". */
function passing(r) {
  if (r.has_clearance && r.clearance_m > 0 && r.miss_m < 15) return `${amount(r.clearance_m)} m over its top (± ${amount(r.clearance_sd_m)})`;
  return r.miss_m > 0 ? `${amount(r.miss_m)} m past it (± ${amount(r.miss_sd_m)})` : "through it";
}

function when(r) {
  return r.hazard_s > 0 ? `in ${Math.round(r.hazard_s)} s` : "now";
}

/** What the answer is worth: why it is suspect, how old it is; empty if neither. */
export function doubts(r) {
  const found = [];
  if (r.suspect) found.push(`Suspect: ${REASONS[r.reason] ?? r.reason}. Margins are wider.`);
  if (r.valid && r.age_s > 0.25) found.push(`Not measured for ${r.age_s.toFixed(1)} s: an older answer, carried on.`);
  return found.join(" ");
}

/** A headline and a line below it. */
export function order(r) {
  const words = `${when(r)}, ${passing(r)}`;
  switch (r.order) {
    case ORDER.goAround:
      return { name: "go-around", head: "Go around", line: words };
    case ORDER.doubt:
      return { name: "doubt", head: "Keep watching", line: `perhaps too close: ${words}; there is time to look longer` };
    case ORDER.uncertain:
      return { name: "doubt", head: "Keep watching", line: `too uncertain to say: ${words}` };
    case ORDER.clear:
      return { name: "clear", head: "Clear", line: `passes ${words}` };
    default:
      return { name: "nothing", head: "Nothing known yet", line: STATUS[r.status] ?? r.status.replaceAll("_", " ") };
  }
}
