// SVG from numbers and known words. SPDX-License-Identifier: MIT

/** A number for an attribute: a hundredth of a pixel is enough. */
const short = (value) => (typeof value === "number" ? String(Math.round(value * 100) / 100) : value);

/** An element; `more`: its content. */
export function el(name, attributes, more = "") {
  const given = Object.entries(attributes).map(([key, value]) => ` ${key}="${short(value)}"`).join("");
  return `<${name}${given}>${more}</${name}>`;
}

export const points = (list) => list.map(([x, y]) => `${short(x)},${short(y)}`).join(" ");

export const text = (x, y, words, more = {}) => el("text", { x, y, ...more }, words);

/** Corners around a center, in meters (ahead, right): of a box by its two axes, of a circle a polygon. */
export function outline(middle, width_m, length_m, across, along) {
  if (!across) {
    return Array.from({ length: 48 }, (_, i) => {
      const angle = (2 * Math.PI * i) / 48;
      return [middle[0] + 0.5 * width_m * Math.cos(angle), middle[1] + 0.5 * width_m * Math.sin(angle)];
    });
  }
  return [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([a, b]) =>
    [0, 1].map((i) => middle[i] + 0.5 * (a * width_m * across[i] + b * length_m * along[i])));
}

/** The true outline, relative to the aircraft. */
export function trueOutline(r) {
  const turn = (r.true_orientation_deg * Math.PI) / 180;
  const along = [Math.cos(turn), Math.sin(turn)];
  return outline([r.true_ahead_m, r.true_right_m], r.true_width_m, r.true_length_m,
    r.true_round ? null : [-along[1], along[0]], along);
}

/** Half axes and direction (radians from ahead to the right) of the ellipse of `sigmas` sigma. */
export function ellipse(aa, ar, rr, sigmas) {
  const mean = 0.5 * (aa + rr);
  const spread = Math.hypot(0.5 * (aa - rr), ar);
  return {
    long: sigmas * Math.sqrt(Math.max(mean + spread, 0)),
    short: sigmas * Math.sqrt(Math.max(mean - spread, 0)),
    angle: 0.5 * Math.atan2(2 * ar, aa - rr),
  };
}
