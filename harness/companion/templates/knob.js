/* Turn the knob: motion programs of Maxima, followed by the classical method of Runge and Kutta. */
"use strict";

{{ models.linear.motion | javascript("motion") }}
{{ models.linear.constraints | javascript("constraints") }}
{{ drawing[1] | javascript("drawing") }}
{% for law, model in models.items() %}
{{ model.law | javascript("law_" ~ law) }}
{% endfor %}
const LAWS = {{ "{" }}{% for law in models %}{{ law }}: law_{{ law }}, {% endfor %}};
const DATA = {{ {"coordinates": models.linear.coordinates, "until": 4, "samples": samples, "shapes": drawing[0]} | tojson }};

const knob = (() => {
  const LONGEST = 0.005;  // step
  const places = DATA.coordinates, rates = places.map(name => `dot(${name})`), n = places.length;

  /* A program's outputs by name, given its inputs by name. */
  function run(program, values) {
    const results = program.evaluate(program.inputs.map(name => values[name]));
    return Object.fromEntries(program.outputs.map((name, k) => [name, results[k]]));
  }

  /* The settings, the time, the state y = [coordinates, velocities] and the control with its derivatives, by name. */
  function known(settings, t, y) {
    const state = Object.fromEntries([...places, ...rates].map((name, i) => [name, y[i]]));
    const values = {...settings, ...state, t};
    return {...values, ...run(LAWS[settings.law], values)};
  }

  /* The initial state: the last coordinate and its velocity follow from the constraint. */
  function start(settings) {
    const y = [...places, ...rates].map(name => settings[name] ?? 0);
    for (const [i, residual] of [[n - 1, "residual[1]"], [2*n - 1, "residual_rate[1]"]]) {
      const found = run(constraints, known(settings, 0, y));
      y[i] -= found[residual]/found[`J[1,${n}]`];
    }
    return y;
  }

  /* The state after a step of the size h. */
  function step(rate, t, y, h) {
    const moved = (part, slope) => y.map((value, i) => value + part*slope[i]);
    const first = rate(t, y), second = rate(t + h/2, moved(h/2, first));
    const third = rate(t + h/2, moved(h/2, second)), fourth = rate(t + h, moved(h, third));
    return moved(h/6, first.map((slope, i) => slope + 2*second[i] + 2*third[i] + fourth[i]));
  }

  /* Samples of the motion under settings { law, u0, omega, kappa, k, c, q1, q2, dot(q1), dot(q2) }. */
  function follow(settings, until = DATA.until, samples = DATA.samples) {
    const rate = (t, y) => {
      const found = run(motion, known(settings, t, y));
      return [...y.slice(n), ...places.map(name => found[`ddot(${name})`])];
    };
    const steps = Math.ceil(until/(samples - 1)/LONGEST), h = until/(samples - 1)/steps, seen = [];
    for (let j = 0, y = start(settings); j <= (samples - 1)*steps; y = step(rate, j*h, y, h), j++) {
      if (j % steps) continue;
      const values = known(settings, j*h, y), found = run(constraints, values), {lambda1} = run(motion, values);
      const along = rates.map((name, i) => (found[`J[1,${i + 1}]`] ?? 0)*values[name]);
      seen.push({...values, lambda1, power: lambda1*along.reduce((a, b) => a + b)});
    }
    return seen;
  }

  /* The singular times nearest to t = 0, one of each conjugate pair: where the denominator 1 + 2u^2 of the accelerations is zero. */
  function singularities({law, u0, omega, kappa, k, c, q1, q2, "dot(q1)": v1, "dot(q2)": v2}) {
    const equal = (one, other) => Math.abs(one - other) < 1e-9;
    if (equal(q1, -q2) && equal(v1, -v2)) return [];  // q1 + q2 stays zero, and so does the multiplier
    if (law === "linear") return [[-u0, Math.SQRT1_2]];
    if (equal(u0, 0)) return [];  // the plane stays flat
    const size = 1/(Math.SQRT2*Math.abs(u0)), quarter = Math.PI/2;
    if (law === "swinging") return [-1, 1].map(sign => [sign*quarter/omega, Math.asinh(size)/omega]);
    if (equal(kappa, 0) || (equal(k, kappa*kappa) && equal(c, 2*kappa))) return [];  // at rest, or every motion is free
    return [[Math.log(size)/kappa, Math.abs(quarter/kappa)]];
  }

  const radius = settings => Math.min(Infinity, ...singularities(settings).map(point => Math.hypot(...point)));

  return {follow, singularities, radius, run};
})();

if (typeof module === "object") module.exports = knob;

/* ---- the page ---------------------------------------------------------------------------------------------- */

if (typeof document === "object") document.addEventListener("DOMContentLoaded", () => {
  const form = document.getElementById("knob"), {time, play} = form.elements;
  const LEFT = 46, BELOW = 36, TOP = 20;
  const COLOURS = ["#0072b2", "#d55e00", "#009e73"], DASHES = ["none", "7 4", "2 4"];

  const rounded = x => x === Infinity ? "∞" : Math.abs(x) < 1e-9 ? "0" : String(Number(x.toPrecision(3)));

  /* An empty picture of points within limits, with equal scales where they are of one plane, and what draws in it. */
  function chart(svg, [left, right], [low, high], {equal = false, width = 360, height = 200} = {}) {
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    let [wide, tall] = [(width - LEFT - 10)/(right - left), (height - TOP - BELOW)/(high - low)];
    if (equal) wide = tall = Math.min(wide, tall);
    const place = ([x, y]) => [LEFT + wide*(x - left), height - BELOW - tall*(y - low)];
    const add = (name, attributes, text = "") => {
      const made = document.createElementNS("http://www.w3.org/2000/svg", name);
      for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
      made.textContent = text;
      svg.append(made);
    };
    const line = (points, attributes) => add("polyline", {
      points: points.map(place).map(p => p.map(x => x.toFixed(2)).join()).join(" "), fill: "none", "stroke-width": 1.8, ...attributes});
    return {place, add, line};
  }

  /* Axes with titles, and a line at each of the heights. */
  function axes({place, add, line}, xs, ys, {across, upward}) {
    const left = xs[0], right = xs[xs.length - 1], [middle, bottom] = place([(left + right)/2, ys[0]]);
    for (const x of xs) add("text", {x: place([x, 0])[0], y: bottom + 16, "text-anchor": "middle"}, rounded(x));
    for (const y of ys) {
      line([[left, y], [right, y]], {stroke: "currentColor", opacity: y === 0 ? 0.6 : 0.2});
      add("text", {x: LEFT - 5, y: place([left, y])[1] + 4, "text-anchor": "end"}, rounded(y));
    }
    add("text", {x: middle, y: bottom + 31, "text-anchor": "middle", class: "axis"}, across);
    add("text", {x: 2, y: 12, class: "axis"}, upward);
  }

  function curves(svg, seen, now) {
    const names = svg.dataset.curves.split(" "), values = seen.flatMap(each => names.map(name => each[name]));
    let [low, high] = [Math.min(0, ...values), Math.max(0, ...values)];
    if (high - low < 1e-9) [low, high] = [-1, 1];
    const drawn = chart(svg, [0, DATA.until], [low, high]);
    axes(drawn, [0, DATA.until/2, DATA.until], [low, low*high < 0 ? 0 : (low + high)/2, high], svg.dataset);
    names.forEach((name, k) => drawn.line(seen.map(each => [each.t, each[name]]),
      {stroke: COLOURS[k], "stroke-dasharray": DASHES[k], "data-curve": name}));
    drawn.line([[now, low], [now, high]], {stroke: "currentColor", opacity: 0.5});
  }

  /* Singular times and the circle within which the series converges, at the scale of the circle. */
  function plane(svg, found, radius) {
    const limit = found.length ? 1.5*radius : 3, ticks = [-limit, 0, limit];
    const drawn = chart(svg, [-limit, limit], [-limit, limit], {equal: true});
    axes(drawn, ticks, ticks, svg.dataset);
    const [cx, cy] = drawn.place([0, 0]), r = drawn.place([radius, 0])[0] - cx;
    if (found.length) drawn.add("circle", {cx, cy, r, fill: COLOURS[0], "fill-opacity": 0.15, stroke: COLOURS[0]});
    for (const [re, im] of found.flatMap(([re, im]) => [[re, im], [re, -im]])) {
      const [x, y] = drawn.place([re, im]);
      drawn.add("path", {d: `M${x - 4},${y - 4} l8,8 m0,-8 l-8,8`, stroke: COLOURS[1], "stroke-width": 1.8});
    }
  }

  /* The system as its file draws it, at one of the samples. */
  function picture(svg, seen, now) {
    const shapes = each => {
      const numbers = Object.entries(knob.run(drawing, each));
      const of = i => numbers.filter(([name]) => name.startsWith(`drawing[${i + 1},`)).map(([, number]) => number);
      return DATA.shapes.map((_, i) => of(i).flatMap((x, k, all) => k % 2 ? [] : [[x, all[k + 1]]]));
    };
    const all = seen.map(shapes), last = DATA.shapes.length - 1;
    /* The view follows the surfaces and the particle; the rest of the path is cut off. */
    const close = all[now].filter((points, i) => points.length > 3 || i === last).flat();
    const extent = k => {
      const found = close.map(p => p[k]), low = Math.min(...found), high = Math.max(...found), room = 0.4*(high - low) + 0.3;
      return [low - room, high + room];
    };
    const {place, add, line} = chart(svg, extent(0), extent(1), {equal: true, width: 720, height: 340});
    line(all.map(each => each[last][0]), {stroke: COLOURS[1], opacity: 0.5});
    all[now].forEach((points, i) => {
      const [cx, cy] = place(points[0]);
      if (DATA.shapes[i] === "point") add("circle", {cx, cy, r: 5, fill: COLOURS[1]});
      else line(points, {stroke: points.length > 3 ? COLOURS[0] : "currentColor"});
    });
  }

  const settings = () => Object.fromEntries([...new FormData(form)].map(([name, value]) => [name, name === "law" ? value : Number(value)]));
  let seen, radius, timer = 0;

  function show() {
    const now = Number(time.value), shown = {...settings(), ...seen[now], radius};
    for (const output of form.querySelectorAll("output")) output.value = rounded(shown[output.name]);
    for (const svg of document.querySelectorAll("svg[data-curves]")) curves(svg, seen, shown.t);
    picture(document.getElementById("picture"), seen, now);
  }

  /* Announce the settings to a screen reader when a change has ended. */
  function announce() {
    const status = form.querySelector("[role=status]");
    status.textContent = status.dataset.text.replace(/\{(\w+)\}/g, (_, name) => form.elements[name].value);
  }

  function turn() {
    const given = settings();
    [seen, radius] = [knob.follow(given), knob.radius(given)];
    for (const label of form.querySelectorAll("label[data-law]")) label.hidden = label.dataset.law !== given.law;
    time.max = seen.length - 1;
    plane(document.getElementById("plane"), knob.singularities(given), radius);
    show();
  }

  function stop() {
    timer = clearInterval(timer);
    play.textContent = play.dataset.play;
    announce();
  }

  function forward() {
    time.value = Number(time.value) + 1;
    show();
    if (time.value === time.max) stop();
  }

  function start() {
    if (time.value === time.max) time.value = 0;
    play.textContent = play.dataset.pause;
    timer = setInterval(forward, 1000*DATA.until/DATA.samples);
  }

  form.addEventListener("input", event => event.target === time ? show() : turn());
  form.addEventListener("change", announce);
  play.addEventListener("click", () => timer ? stop() : start());
  form.hidden = false;
  turn();
});
