// The page: loads and verifies the modules, reads the controls, repeats the flight after each change, plays it. SPDX-License-Identifier: MIT

import { Goe, LiveFlight } from "../goe.mjs";
import { drawCamera } from "./camera.mjs";
import { drawChart, isEdge, QUANTITIES, read } from "./chart.mjs";
import { drawMap } from "./map.mjs";
import { amount, doubts, HAS, order, side } from "./words.mjs";

const find = (id) => document.getElementById(id);
const SEEDS = 1000;
const STILL_SHARE = 0.6; // of the flight: shown first if the reader prefers reduced motion

// ------------------------------------------------------------------------------------------------------------ modules

/** An embedded module as bytes. */
function embedded(id) {
  const text = atob(find(id).textContent.trim());
  return Uint8Array.from(text, (letter) => letter.charCodeAt(0));
}

function showProof(right, words) {
  const badge = find("proof");
  badge.className = right ? "right" : "wrong";
  badge.innerHTML = words;
}

/** Replays the test logs with this page's library and compares the hash over every output bit with the recorded one. */
async function prove(goe, golden) {
  const expected = find("proof").dataset.expected;
  const hash = await goe.goldenHash(golden);
  const right = hash === expected && goe.selfCheck() === 0;
  showProof(right, right
    ? `<b>✓ Verified: same bits as on flight controllers</b> (hash ${hash})`
    : `<b>✗ Library check failed: wrong hash ${hash}</b>, expected ${expected}: trust nothing on this page`);
}

// ------------------------------------------------------------------------------------------------------------ controls

const inputs = () => [...document.querySelectorAll("[data-control]")];

/** All controls as numbers, by their names in live.h. */
function readControls() {
  const given = { seed: seed };
  for (const input of inputs()) {
    if (input.type === "radio" ? input.checked : input.type !== "checkbox") given[input.dataset.control] = Number(input.value);
    if (input.type === "checkbox") given[input.dataset.control] = input.checked ? 1 : 0;
  }
  return given;
}

/** Sets the controls from the fragment of the address: #kind=2&roll_deg=10&t=8. Returns t, or null. */
function applyFragment() {
  const given = new URLSearchParams(location.hash.slice(1));
  for (const input of inputs()) {
    const value = given.get(input.dataset.control);
    if (value === null) continue;
    if (input.type === "radio") input.checked = input.value === value;
    else if (input.type === "checkbox") input.checked = value === "1";
    else input.value = value;
  }
  if (given.has("seed")) seed = Number(given.get("seed")) || 0;
  return given.has("t") ? Number(given.get("t")) : null;
}

const SAYS = {
  roll_deg: (v) => (v ? `${v}° each way` : "none"),
  pixel_px: (v) => `${v.toFixed(1)} px`,
  height_offset_m: (v) => (v ? `reads ${Math.abs(v)} m too ${v > 0 ? "high" : "low"}` : "none"),
  side_m: (v) => (v ? `${Math.abs(v)} m ${v < 0 ? "left" : "right"} of the course` : "on the course"),
};

function showControls() {
  for (const [name, say] of Object.entries(SAYS)) {
    const words = say(Number(find(name).value));
    find(`${name}-says`).textContent = words;
    find(name).setAttribute("aria-valuetext", words);
  }
}

// -------------------------------------------------------------------------------------------------------------- flight

let live = null;
let flight = [];
let at = 0;
let first_s = null; // time of the first estimate
let seed = 1;
let playing = false;
let started_ms = 0; // start of playback, so that the present image is due now

function fly() {
  showControls();
  flight = live.fly(readControls());
  find("time").max = flight.length - 1;
  first_s = flight.find((r) => r.valid & HAS.position)?.time_s ?? null;
  at = Math.min(at, flight.length - 1);
  show();
}

function value(r, id) {
  const quantity = QUANTITIES.find((q) => q.id === id);
  const now = read(quantity, r);
  const words = (v) => (id === "side" ? side(v) : `${amount(v)} m`);
  find(`${id}-value`).innerHTML = now ? `${words(now[0])} <small>± ${amount(now[1])}</small>` : "–";
  find(`${id}-truth`).textContent = now ? `truth ${words(now[2])}` : "";
  find(`${id}-value`).dataset.value = now ? now[0] : "";
  find(`${id}-value`).dataset.sigma = now ? now[1] : "";
}

function show() {
  const r = flight[at];
  const decision = order(r, first_s);
  find("order").className = decision.name;
  find("order-head").textContent = decision.head;
  find("order-line").textContent = decision.line;
  find("doubts").textContent = doubts(r);
  find("order").dataset.suspect = r.suspect ? r.reason : "";
  find("order").dataset.at = at;
  find("width-title").textContent = isEdge(r) ? "Width of the front" : "Width across the line of sight";
  find("turned").textContent = r.valid & HAS.orientation
    ? `Orientation ${amount(r.orientation_deg)}° ± ${amount(r.orientation_sd_deg)} (truth ${amount(r.true_orientation_deg)}°)` +
      (r.valid & HAS.length ? `, length ${amount(r.length_m)} m ± ${amount(r.length_sd_m)} (truth ${amount(r.true_length_m)} m).` : ".")
    : "";
  find("time").value = at;
  find("time").setAttribute("aria-valuetext", `${r.time_s.toFixed(1)} seconds`);
  find("time-says").textContent = `${r.time_s.toFixed(1)} s`;
  drawMap(find("map"), flight, at);
  drawCamera(find("camera"), r);
  for (const quantity of QUANTITIES) {
    value(r, quantity.id);
    drawChart(find(`${quantity.id}-chart`), quantity, flight, at);
  }
}

// ---------------------------------------------------------------------------------------------------------------- play

function setPlaying(on) {
  playing = on;
  find("play").textContent = on ? "❚❚ Pause" : "▶ Play";
  find("play").setAttribute("aria-pressed", String(on));
  if (on) {
    started_ms = performance.now() - 1000 * flight[at].time_s;
    requestAnimationFrame(tick);
  }
}

function tick(now_ms) {
  if (!playing) return;
  const interval_s = flight[1].time_s - flight[0].time_s;
  const next = Math.min(Math.floor((now_ms - started_ms) / 1000 / interval_s), flight.length - 1);
  if (next !== at && next >= 0) {
    at = next;
    show();
  }
  if (at === flight.length - 1) setPlaying(false);
  else requestAnimationFrame(tick);
}

function playOrPause() {
  if (!playing && at === flight.length - 1) at = 0;
  setPlaying(!playing);
}

function replay() {
  at = 0;
  show();
  setPlaying(true);
}

function goTo(image) {
  at = Math.max(0, Math.min(image, flight.length - 1));
  setPlaying(false);
  show();
}

function newNoise() {
  seed = (seed % SEEDS) + 1;
  fly();
}

const KEYS = {
  " ": playOrPause,
  k: playOrPause,
  r: replay,
  n: newNoise,
  ArrowLeft: () => goTo(at - 1),
  ArrowRight: () => goTo(at + 1),
  Home: () => goTo(0),
  End: () => goTo(flight.length - 1),
};

/** Keys that the focused control handles itself. */
function ownKey(target, key) {
  if (key === " ") return target.matches("button, summary, a, input[type=checkbox], input[type=radio]");
  return target.matches("input") && /^(Arrow|Home|End|Page)/.test(key);
}

function onKey(event) {
  const act = KEYS[event.key.length === 1 ? event.key.toLowerCase() : event.key];
  if (!act || event.ctrlKey || event.altKey || event.metaKey || ownKey(event.target, event.key)) return;
  event.preventDefault();
  act();
}

// --------------------------------------------------------------------------------------------------------------- start

function listen() {
  inputs().forEach((input) => input.addEventListener("input", fly));
  find("time").addEventListener("input", () => goTo(Number(find("time").value)));
  find("play").addEventListener("click", playOrPause);
  find("replay").addEventListener("click", replay);
  find("noise").addEventListener("click", newNoise);
  document.addEventListener("keydown", onKey);
  new ResizeObserver(() => flight.length && show()).observe(document.body);
}

async function start() {
  const [library, flightModule, golden] = ["goe", "flight", "golden"].map((name) => {
    const bytes = embedded(`${name}-module`);
    find(`${name}-bytes`).textContent = bytes.length.toLocaleString("en");
    return bytes;
  });
  const goe = await Goe.load(library);
  live = await LiveFlight.load(goe, flightModule);
  find("version").textContent = live.version;
  const wanted_s = applyFragment();
  fly();
  listen();
  if (wanted_s !== null) goTo(Math.round(wanted_s * (flight.length - 1) / flight[flight.length - 1].time_s));
  else if (matchMedia("(prefers-reduced-motion: reduce)").matches) goTo(Math.round(STILL_SHARE * (flight.length - 1)));
  else setPlaying(true);
  await prove(goe, golden);
  document.documentElement.dataset.ready = "yes";
}

start().catch((error) => {
  showProof(false, "<b>✗ Library check failed: wrong module</b>, it does not run: trust nothing on this page");
  find("proof").title = String(error);
  document.documentElement.dataset.ready = "failed";
});
