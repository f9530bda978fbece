/* The page of goe_tools view: unpacks its data, draws map and charts with plotly.js, moves through time. */
"use strict";
(() => {
  const $ = (id) => document.getElementById(id);
  const PLAIN = { displayModeBar: false, responsive: true, scrollZoom: false, doubleClick: false };
  const FONT = '-apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, "Liberation Sans", sans-serif';
  const CIRCLE_POINTS = 60;
  const MAP_MARGIN = { l: 46, r: 8, t: 8, b: 30 };
  const CLOSE_STEPS_M = [8, 15, 25, 40, 65, 100, 160, 250, 400, 650, 1000];
  const GONE_S = 1; // an obstacle without an image for longer is out of view
  const PAGE_SHARE = 20; // number of PageDown steps through the whole log
  const state = { moment: 0, track: 0, view: "whole", playing: false };
  let story, plots = [];

  /* ------------------------------------------------------------------------------------------------- unpacking -- */

  async function inflate(id) {
    const bytes = Uint8Array.from(atob($(id).textContent), (c) => c.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    $(id).remove();
    return new Response(stream).arrayBuffer();
  }

  const textOf = async (id) => new TextDecoder().decode(await inflate(id));

  async function unpack() {
    if (typeof DecompressionStream === "undefined") {
      throw new Error("this browser cannot unpack the page (DecompressionStream: Chrome 80, Firefox 113, Safari 16.4)");
    }
    const script = document.createElement("script");
    script.textContent = await textOf("plotly-packed");
    document.head.append(script);
    story = JSON.parse(await textOf("data-packed"));
    const numbers = new Float32Array(await inflate("numbers-packed"));
    const columns = (places) =>
      Object.fromEntries(Object.entries(places).map(([name, [start, count]]) => [name, numbers.subarray(start, start + count)]));
    story.moments = columns(story.moments);
    for (const track of story.tracks) track.columns = columns(track.columns);
  }

  /* ---------------------------------------------------------------------------------------------------- colors -- */

  const color = (name) => getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
  const axisLook = () => ({
    gridcolor: color("grid"), zerolinecolor: color("faint"), linecolor: color("faint"), color: color("soft"),
    tickfont: { size: 11, color: color("soft") }, fixedrange: true, zeroline: false,
  });
  const layoutLook = () => ({
    paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)", font: { family: FONT, size: 12, color: color("ink") },
    showlegend: false, dragmode: false, hoverlabel: { bgcolor: color("panel"), bordercolor: color("faint"), font: { color: color("ink") } },
  });

  /* ----------------------------------------------------------------------------------------------------- charts -- */

  /* Runs [first, last] of indices for which test() is true. */
  function runs(count, test) {
    const found = [];
    for (let k = 0; k < count; k++) {
      if (!test(k)) continue;
      if (found.length && found[found.length - 1][1] === k - 1) found[found.length - 1][1] = k;
      else found.push([k, k]);
    }
    return found;
  }

  /* One closed outline for each run of known values. */
  function band(t, value, sigma, least) {
    const x = [], y = [];
    const low = (k) => (least === null ? value[k] - 2 * sigma[k] : Math.max(least, value[k] - 2 * sigma[k]));
    for (const [a, b] of runs(t.length, (k) => Number.isFinite(value[k]) && Number.isFinite(sigma[k]))) {
      for (let k = a; k <= b; k++) { x.push(t[k]); y.push(value[k] + 2 * sigma[k]); }
      for (let k = b; k >= a; k--) { x.push(t[k]); y.push(low(k)); }
      x.push(t[a], null); y.push(value[a] + 2 * sigma[a], null);
    }
    return { x, y };
  }

  function doubtful(track, [low, high]) {
    const x = [], y = [], t = track.columns.time;
    for (const [a, b] of runs(t.length, (k) => track.columns.suspect[k] > 0)) {
      const end = t[Math.min(b + 1, t.length - 1)];
      x.push(t[a], t[a], end, end, t[a], null);
      y.push(low, high, high, low, low, null);
    }
    return { x, y };
  }

  function chartTraces(chart, own, track) {
    const c = track.columns, t = Array.from(c.time), traces = [];
    const quiet = { mode: "lines", hoverinfo: "skip" };
    const value = c[chart.key];
    if (chart.key === "nis_ratio") {
      traces.push({ ...quiet, ...doubtful(track, own.range), fill: "toself", fillcolor: color("suspect-pale"), line: { width: 0 } });
    }
    if (chart.sigma) {
      traces.push({ ...quiet, ...band(t, value, c[chart.sigma], chart.least), fill: "toself", fillcolor: color("region"), line: { width: 0 } });
    }
    if (chart.limit !== null) {
      traces.push({ ...quiet, x: [t[0], t[t.length - 1]], y: [chart.limit, chart.limit], line: { color: color("suspect"), width: 1.5, dash: "dot" } });
    }
    const truth = c["true_" + chart.key];
    if (truth) traces.push({ ...quiet, name: "truth", x: t, y: Array.from(truth), line: { color: color("true"), width: 2, dash: "dash" } });
    traces.push({
      name: "estimate", mode: t.length > 1 ? "lines" : "markers", x: t, y: Array.from(value), text: own.text, line: { color: color("estimate"), width: 2 },
      marker: { color: color("estimate"), size: 7 }, hovertemplate: "%{x:.2f} s: %{text}<extra></extra>",
    });
    return traces;
  }

  function chartLayout(chart, own, track) {
    const t = track.columns.time;
    const spare = t[t.length - 1] > t[0] ? 0 : 0.5;
    return {
      ...layoutLook(), margin: { l: 44, r: 8, t: 6, b: 24 }, hovermode: "x",
      xaxis: { ...axisLook(), range: [t[0] - spare, t[t.length - 1] + spare], nticks: 6, ticksuffix: " s" },
      yaxis: { ...axisLook(), range: own.range, nticks: 5 },
    };
  }

  function makeCharts() {
    const track = story.tracks[state.track], box = $("charts"), absent = [];
    box.replaceChildren();
    plots = [];
    story.charts.forEach((chart, i) => {
      const own = track.charts[i];
      if (!own) { absent.push(chart.title.toLowerCase()); return; }
      const panel = document.createElement("section");
      panel.className = "chart";
      panel.dataset.key = chart.key;
      panel.innerHTML = '<h2><span></span><output></output></h2><p></p><div class="plot" role="img"></div>';
      panel.querySelector("span").textContent = chart.title;
      panel.querySelector("p").textContent = chart.note;
      const plot = panel.querySelector(".plot");
      plot.setAttribute("aria-label", `${chart.title} over time`);
      panel.setAttribute("aria-label", chart.title);
      box.append(panel);
      Plotly.newPlot(plot, chartTraces(chart, own, track), chartLayout(chart, own, track), PLAIN);
      plot.on("plotly_click", (event) => goTo(momentAt(event.points[0].x)));
      plots.push({ chart, own, plot, output: panel.querySelector("output") });
    });
    $("absent").textContent = absent.length ? `Never estimated in this log: ${absent.join(", ")}.` : "";
  }

  function moveCursors(row, now) {
    const column = story.tracks[state.track].columns;
    for (const { chart, own, plot, output } of plots) {
      output.textContent = row < 0 ? "–" : own.text[row];
      const shapes = [{ type: "line", x0: now, x1: now, yref: "paper", y0: 0, y1: 1, line: { color: color("ink"), width: 1.25 } }];
      const value = row < 0 ? NaN : column[chart.key][row];
      if (Number.isFinite(value)) {
        shapes.push({
          type: "circle", xsizemode: "pixel", ysizemode: "pixel", xanchor: column.time[row], yanchor: value, x0: -5, x1: 5, y0: -5, y1: 5,
          fillcolor: color("estimate"), line: { color: color("panel"), width: 2 },
        });
      }
      Plotly.relayout(plot, { shapes });
    }
  }

  /* -------------------------------------------------------------------------------------------------------- map -- */

  const pair = (column, k) => [column[2 * k], column[2 * k + 1]];
  const polygon = (column, k, count) => {
    const points = [];
    for (let i = 0; i < count; i++) points.push(pair(column, k * count + i));
    return points.concat([points[0]]);
  };

  function circle(column, k) {
    const [x, y, r] = column.subarray(3 * k, 3 * k + 3);
    return Array.from({ length: CIRCLE_POINTS + 1 }, (_, i) => {
      const turn = (2 * Math.PI * i) / CIRCLE_POINTS;
      return [x + r * Math.sin(turn), y + r * Math.cos(turn)];
    });
  }

  const known = (points) => points.length > 0 && points.every((p) => Number.isFinite(p[0]) && Number.isFinite(p[1]));
  const outline = (track, k) => (Number.isFinite(track.columns.circle[3 * k]) ? circle(track.columns.circle, k) : polygon(track.columns.corner, k, 4));
  const region = (track, k) => polygon(track.columns.region, k, track.columns.region.length / (2 * track.columns.time.length));
  const rowAt = (track, moment) => track.columns.rowAt[moment];

  /* Of a closed polygon: its first point is also its last. */
  const middleOf = (points) => [0, 1].map((i) => points.slice(1).reduce((sum, p) => sum + p[i], 0) / (points.length - 1));

  /* The path of a moving outline until the closest approach, and its position then. */
  function passing(there, moved) {
    const [x, y] = middleOf(there);
    return [[[x, y], moved], there.map((p) => [p[0] + moved[0] - x, p[1] + moved[1] - y])];
  }

  /* Several lines as one trace. */
  function lines(parts) {
    const x = [], y = [];
    for (const part of parts.filter(known)) {
      for (const p of part) { x.push(p[0]); y.push(p[1]); }
      x.push(null); y.push(null);
    }
    return { x, y };
  }

  function path(from, to) {
    const parts = [[]], m = story.moments;
    for (let k = from; k <= to; k++) {
      if (m.broken[k] && k > from) parts.push([]);
      parts[parts.length - 1].push(pair(m.path, k));
    }
    return lines(parts);
  }

  function wedge(moment, reach) {
    const [left, right] = pair(story.moments.look, moment), [x, y] = pair(story.moments.path, moment);
    if (!Number.isFinite(left + right)) return [];
    const turn = Math.atan2(Math.sin(right - left), Math.cos(right - left)), span = turn < 0 ? turn + 2 * Math.PI : turn;
    const points = [[x, y]];
    for (let i = 0; i <= 24; i++) points.push([x + reach * Math.sin(left + (span * i) / 24), y + reach * Math.cos(left + (span * i) / 24)]);
    return points.concat([[x, y]]);
  }

  function reachOf(moment) {
    const [x, y] = pair(story.moments.path, moment), [x0, x1, y0, y1] = story.bounds;
    const track = story.tracks[state.track], row = rowAt(track, moment);
    const there = row >= 0 ? outline(track, row) : [];
    return known(there) ? Math.max(...there.map((p) => Math.hypot(p[0] - x, p[1] - y))) * 1.08 : 0.4 * Math.hypot(x1 - x0, y1 - y0);
  }

  function mapParts(moment) {
    const track = story.tracks[state.track], row = rowAt(track, moment), at = pair(story.moments.path, moment);
    const others = story.tracks.filter((other) => other !== track && rowAt(other, moment) >= 0);
    const there = row >= 0 ? outline(track, row) : [], located = known(there);
    const closest = located ? pair(track.columns.closest, row) : [NaN, NaN], nearest = located ? pair(track.columns.nearest, row) : [NaN, NaN];
    const ahead = known([closest]);
    const [vx, vy] = pair(story.moments.velocity, moment);
    return {
      wedge: lines([wedge(moment, reachOf(moment))]),
      otherRegions: lines(others.map((o) => region(o, rowAt(o, moment)))),
      others: lines(others.map((o) => outline(o, rowAt(o, moment)))),
      region: lines(located ? [region(track, row)] : []),
      later: path(moment, story.moments.time.length - 1),
      flown: path(0, moment),
      outline: lines(located ? [there] : []),
      truths: lines(story.tracks.map((t) => (t.truth.length ? t.truth.concat([t.truth[0]]) : []))),
      course: lines(ahead ? [[at, closest], ...passing(there, pair(track.columns.moved, row))] : []),
      miss: lines(ahead ? [[closest, nearest]] : []),
      closest: { x: ahead ? [closest[0]] : [], y: ahead ? [closest[1]] : [] },
      aircraft: { x: [at[0]], y: [at[1]], "marker.angle": Number.isFinite(vx) ? (Math.atan2(vx, vy) * 180) / Math.PI : 0 },
      names: names(moment),
    };
  }

  function names(moment) {
    const places = story.tracks.length > 1 ? story.tracks.map((t) => [t, rowAt(t, moment)]).filter(([t, k]) => k >= 0 && known(outline(t, k))) : [];
    const tops = places.map(([t, k]) => outline(t, k).reduce((a, b) => (b[1] > a[1] ? b : a)));
    return { x: tops.map((p) => p[0]), y: tops.map((p) => p[1]), text: places.map(([t]) => String(t.id)) };
  }

  function mapLooks() {
    const line = (name, width, dash = "solid") => ({ mode: "lines", line: { color: color(name), width, dash } });
    const area = (fill, edge, width = 1) => ({ mode: "lines", fill: "toself", fillcolor: color(fill), line: { color: color(edge), width } });
    const estimate = area("region", "estimate", 2.5);
    return {
      wedge: { mode: "lines", fill: "toself", fillcolor: color("look"), line: { width: 0 } },
      otherRegions: area("other-pale", "other-pale"), others: line("other", 2), region: area("region", "region-line"),
      truths: line("true", 2, "dash"), later: line("own", 1.2, "dot"), flown: line("own", 2.5), outline: estimate,
      course: line("course", 2, "dash"), miss: line("course", 2), closest: { mode: "markers", marker: { color: color("course"), size: 9, symbol: "diamond" } },
      aircraft: { mode: "markers", marker: { color: color("own"), size: 19, symbol: "arrow", line: { color: color("panel"), width: 1.5 } } },
      names: { mode: "text", textposition: "top center", textfont: { color: color("ink"), size: 12 } },
    };
  }

  function extent(points) {
    const x = points.map((p) => p[0]), y = points.map((p) => p[1]);
    return [Math.min(...x), Math.max(...x), Math.min(...y), Math.max(...y)];
  }

  /* left, right, bottom, top of the map. */
  function wideBounds(moment) {
    const track = story.tracks[state.track], row = rowAt(track, moment);
    const there = row >= 0 ? outline(track, row) : [];
    if (state.view === "whole" || !known(there)) return story.bounds;
    const closest = pair(track.columns.closest, row);
    return extent(there.concat(region(track, row), [pair(story.moments.path, moment)], known([closest]) ? [closest] : [], track.truth));
  }

  /* ... of the close view: around the obstacle's last position, in steps, to show how the region shrinks. */
  function closeBounds(moment) {
    const track = story.tracks[state.track], row = rowAt(track, moment);
    const there = row >= 0 ? outline(track, row) : [], located = known(there);
    const [x0, x1, y0, y1] = located ? extent(there) : [0, 0, 0, 0];
    const [x, y] = track.anchor ?? [0.5 * (x0 + x1), 0.5 * (y0 + y1)];
    const reach = (points) => Math.max(0, ...points.map((p) => Math.max(Math.abs(p[0] - x), Math.abs(p[1] - y))));
    const needed = reach(located ? there.concat(region(track, row), track.truth) : track.truth);
    const half = CLOSE_STEPS_M.find((step) => step >= needed) ?? needed;
    return [x - half, x + half, y - half, y + half];
  }

  /* Ranges with the same scale on both axes. */
  function ranges(map, moment) {
    const [x0, x1, y0, y1] = map.bounds(moment), box = $(map.id).getBoundingClientRect();
    const wide = Math.max(box.width - MAP_MARGIN.l - MAP_MARGIN.r, 50), high = Math.max(box.height - MAP_MARGIN.t - MAP_MARGIN.b, 50);
    const scale = map.margin * Math.max((x1 - x0) / wide, (y1 - y0) / high, 1e-3);
    const x = 0.5 * (x0 + x1), y = 0.5 * (y0 + y1);
    return { "xaxis.range": [x - 0.5 * scale * wide, x + 0.5 * scale * wide], "yaxis.range": [y - 0.5 * scale * high, y + 0.5 * scale * high] };
  }

  const MAPS = [
    { id: "map", bounds: wideBounds, margin: 1.17, ticks: [6, 9], wedge: true },
    { id: "close", bounds: closeBounds, margin: 1.04, ticks: [5, 5], wedge: false },
  ];

  function makeMaps() {
    const looks = mapLooks(), parts = mapParts(state.moment);
    for (const map of MAPS) {
      const limits = ranges(map, state.moment), axis = { ...axisLook(), ticksuffix: " m" };
      const traces = Object.entries(parts).map(([name, part]) => {
        const { "marker.angle": angle, ...rest } = part, look = looks[name];
        const marker = angle === undefined ? {} : { marker: { ...look.marker, angle } };
        return { name, hoverinfo: "skip", visible: map.wedge || name !== "wedge", ...look, ...rest, ...marker };
      });
      Plotly.newPlot(map.id, traces, {
        ...layoutLook(), margin: MAP_MARGIN, hovermode: false,
        xaxis: { ...axis, nticks: map.ticks[0], range: limits["xaxis.range"] },
        yaxis: { ...axis, nticks: map.ticks[1], range: limits["yaxis.range"] },
      }, { ...PLAIN, responsive: false });
    }
    $("north").querySelector("path").setAttribute("transform", `rotate(${story.north} 12 9)`);
  }

  function moveMaps(moment) {
    const parts = Object.values(mapParts(moment)), update = { x: [], y: [], "marker.angle": [], text: [] };
    for (const part of parts) {
      update.x.push(part.x);
      update.y.push(part.y);
      update["marker.angle"].push(part["marker.angle"] ?? 0);
      update.text.push(part.text ?? null);
    }
    for (const map of MAPS) Plotly.update(map.id, update, ranges(map, moment), parts.map((_, i) => i));
  }

  /* ------------------------------------------------------------------------------------------------------- time -- */

  function momentAt(time) {
    const t = story.moments.time;
    let low = 0, high = t.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (t[middle] <= time + 1e-6) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  function say(row, now) {
    const track = story.tracks[state.track];
    const place = row < 0 ? "Not detected yet" : track.place[row], age = row < 0 ? 0 : now - track.columns.time[row];
    $("place").textContent = place;
    $("approach").textContent = row < 0 ? "" : track.approach[row];
    const odds = row < 0 ? NaN : (track.columns.conflict_probability ?? [])[row];
    const act = row >= 0 && track.columns.act[row] > 0;
    if (odds >= 1) $("approach").textContent += `. Conflict probability ${odds.toFixed(0)} %${act ? ": act now" : ""}`;
    $("approach").parentElement.classList.toggle("too-close", act);
    const late = age > 0.05 ? `No image of it for ${age.toFixed(1)} s. ` : "";
    $("state").textContent = row < 0 ? "" : late + track.state[row];
    $("model").textContent = row < 0 || track.model[row] === "none" ? "–" : track.model[row];
    const doubt = row < 0 ? "" : track.doubt[row];
    $("doubt").textContent = doubt;
    $("doubt").hidden = doubt === "";
    $("doubt").classList.toggle("notice", row >= 0 && !track.columns.suspect[row]);
    $("clock").textContent = `${now.toFixed(2)} s`;
    $("time").setAttribute("aria-valuetext", `${now.toFixed(2)} seconds: ${place}`);
    $("map").setAttribute("aria-label", `Map from above: ${place}. ${$("approach").textContent}`);
  }

  function show() {
    const now = story.moments.time[state.moment], row = rowAt(story.tracks[state.track], state.moment);
    $("time").value = state.moment;
    say(row, now);
    moveMaps(state.moment);
    moveCursors(row, now);
    document.documentElement.dataset.shown = String(state.moment);
  }

  let waiting = false;
  function goTo(moment) {
    state.moment = Math.min(Math.max(moment, 0), story.moments.time.length - 1);
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => { waiting = false; show(); });
  }

  let clock = { at: 0, from: 0 };
  function play(on) {
    state.playing = on && story.moments.time.length > 1;
    const last = story.moments.time.length - 1;
    if (state.playing && state.moment === last) state.moment = 0;
    $("play").setAttribute("aria-pressed", String(state.playing));
    $("play").setAttribute("aria-label", state.playing ? "Pause" : "Play");
    $("now").setAttribute("aria-live", state.playing ? "off" : "polite");
    clock = { at: performance.now(), from: story.moments.time[state.moment] };
    if (state.playing) requestAnimationFrame(tick);
  }

  function tick(now) {
    if (!state.playing) return;
    const time = clock.from + ((now - clock.at) / 1000) * Number($("speed").value), moment = momentAt(time);
    if (moment !== state.moment) { state.moment = moment; show(); }
    if (moment >= story.moments.time.length - 1) play(false);
    else requestAnimationFrame(tick);
  }

  const restartClock = () => { clock = { at: performance.now(), from: story.moments.time[state.moment] }; };

  /* Above the slider: when there is an estimate. */
  function drawStrip() {
    const track = story.tracks[state.track], count = story.moments.time.length, strip = $("strip"), rects = [];
    const kind = (moment) => {
      const k = rowAt(track, moment);
      if (k < 0 || !known(outline(track, k))) return "";
      return track.columns.suspect[k] ? "suspect" : track.columns.fresh[k] && story.moments.time[moment] - track.columns.time[k] < 0.05 ? "answer" : "stale";
    };
    const kinds = Array.from({ length: count }, (_, moment) => kind(moment));
    for (const name of ["answer", "stale", "suspect"]) {
      for (const [a, b] of runs(count, (k) => kinds[k] === name)) rects.push([a, b + 1 - a, name]);
    }
    for (let k = 0; k < count; k++) if (story.moments.reset[k]) rects.push([k, Math.max(count / 600, 0.1), "reset"]);
    strip.setAttribute("viewBox", `0 0 ${count} 1`);
    strip.innerHTML = rects.map(([x, w, name]) => `<rect class="${name}" x="${x}" y="0" width="${w}" height="1"/>`).join("");
  }

  /* ------------------------------------------------------------------------------------------------------ hands -- */

  const KEY_STEPS = () => {
    const many = Math.max(1, Math.round(story.moments.time.length / PAGE_SHARE));
    return { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1, PageUp: many, PageDown: -many, Home: -Infinity, End: Infinity };
  };

  function onKey(event) {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const slider = event.target === $("time");
    if (!slider && event.target.closest("button, select, input, a")) return;
    if (event.key === " ") {
      event.preventDefault();
      if (!event.repeat) play(!state.playing);
    } else if (slider ? event.key in KEY_STEPS() : event.key === "ArrowLeft" || event.key === "ArrowRight") {
      event.preventDefault();
      play(false);
      goTo(state.moment + KEY_STEPS()[event.key]);
    }
  }

  function redraw() {
    makeCharts();
    makeMaps();
    drawStrip();
    show();
    for (const drawn of document.querySelectorAll(".js-plotly-plot svg, #js-plotly-tester")) drawn.setAttribute("aria-hidden", "true");
  }

  /* Another obstacle: at the present time, or, if it is out of view then, at its own first moment. */
  function choose(index) {
    const track = story.tracks[index], row = rowAt(track, state.moment);
    if (row < 0 || story.moments.time[state.moment] - track.columns.time[row] > GONE_S) state.moment = track.first;
    state.track = index;
    redraw();
    restartClock();
  }

  function listen() {
    $("time").addEventListener("input", () => { goTo(Number($("time").value)); restartClock(); });
    $("play").addEventListener("click", () => play(!state.playing));
    $("speed").addEventListener("change", restartClock);
    document.addEventListener("keydown", onKey);
    $("obstacle")?.addEventListener("change", (event) => choose(Number(event.target.value)));
    for (const radio of document.getElementsByName("view")) {
      radio.addEventListener("change", () => { state.view = radio.value; goTo(state.moment); });
    }
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", redraw);
    for (const map of MAPS) new ResizeObserver(() => Plotly.Plots.resize(map.id).then(() => goTo(state.moment))).observe($(map.id));
  }

  unpack().then(() => {
    state.track = story.chosen;
    state.moment = story.first;
    state.view = story.view;
    document.querySelector(`input[name="view"][value="${state.view}"]`).checked = true;
    redraw();
    listen();
    document.documentElement.dataset.ready = "yes";
  }).catch((error) => {
    $("problem").textContent = `The page could not be drawn: ${error.message}`;
    $("problem").hidden = false;
    document.documentElement.dataset.ready = "failed";
  });
})();
