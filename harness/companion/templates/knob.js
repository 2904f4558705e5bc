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
  const sum = numbers => numbers.reduce((a, b) => a + b, 0);
  const moved = (y, h, slope) => y.map((value, i) => value + h*slope[i]);

  /* The states at the times, the first of which is that of y. */
  function states(rate, times, y) {
    const found = [y];
    for (let k = 1; k < times.length; k++) {
      const steps = Math.ceil((times[k] - times[k - 1])/LONGEST), h = (times[k] - times[k - 1])/steps;
      for (let j = 0; j < steps; j++) {
        const t = times[k - 1] + j*h, first = rate(t, y), second = rate(t + h/2, moved(y, h/2, first));
        const third = rate(t + h/2, moved(y, h/2, second)), fourth = rate(t + h, moved(y, h, third));
        y = y.map((value, i) => value + h/6*(first[i] + 2*second[i] + 2*third[i] + fourth[i]));
      }
      found.push(y);
    }
    return found;
  }

  /* A program's outputs by name, given its inputs by name. */
  function run(program, values) {
    const results = program.evaluate(program.inputs.map(name => values[name]));
    return Object.fromEntries(program.outputs.map((name, k) => [name, results[k]]));
  }

  /* The motion under settings { law, u0, omega, kappa, k, c, q1, q2, dot(q1), dot(q2) }: q3 and dot(q3) follow from the constraint. */
  function follow(settings, until = DATA.until, samples = DATA.samples) {
    const law = LAWS[settings.law], places = DATA.coordinates, rates = places.map(name => `dot(${name})`);
    const known = (t, y) => {
      const values = {...settings, t};
      places.forEach((name, i) => { values[name] = y[i]; values[rates[i]] = y[places.length + i]; });
      return Object.assign(values, run(law, values));
    };
    const rate = (t, y) => {
      const found = run(motion, known(t, y));
      return [...y.slice(places.length), ...places.map(name => found[`ddot(${name})`])];
    };
    const start = [...places, ...rates].map(name => settings[name] ?? 0), last = places.length;
    for (const [place, residual] of [[last - 1, "residual[1]"], [2*last - 1, "residual_rate[1]"]]) {
      const found = run(constraints, known(0, start));
      start[place] -= found[residual]/found[`J[1,${last}]`];
    }
    const times = Array.from({length: samples}, (_, k) => until*k/(samples - 1));
    const seen = states(rate, times, start).map((y, k) => {
      const values = known(times[k], y), found = run(constraints, values), lambda = run(motion, values).lambda1;
      const power = lambda*sum(rates.map((name, i) => (found[`J[1,${i + 1}]`] ?? 0)*values[name]));
      return {...values, lambda1: lambda, power};
    });
    return {times, seen};
  }

  /* The singular times nearest to t = 0, one of each conjugate pair: where the denominator 1 + 2u^2 of the accelerations is zero. */
  function singularities(settings) {
    const {law, u0, omega, kappa, k, c} = settings, equal = (one, other) => Math.abs(one - other) < 1e-9;
    const zero = (one, other) => equal(settings[one], -settings[other]);
    if (zero("q1", "q2") && zero("dot(q1)", "dot(q2)")) return [];  // q1 + q2 stays zero, and so does the multiplier
    if (law === "linear") return [[-u0, Math.SQRT1_2]];
    if (equal(u0, 0)) return [];  // the plane stays flat
    const size = 1/(Math.SQRT2*Math.abs(u0)), quarter = Math.PI/2;
    if (law === "swinging") return [-1, 1].map(sign => [sign*quarter/omega, Math.asinh(size)/omega]);
    if (equal(kappa, 0) || (equal(k, kappa*kappa) && equal(c, 2*kappa))) return [];  // at rest, or every motion is free
    return [[Math.log(size)/kappa, Math.abs(quarter/kappa)]];
  }

  const radius = settings => Math.min(Infinity, ...singularities(settings).map(point => Math.hypot(...point)));

  return {follow, singularities, radius};
})();

if (typeof module === "object") module.exports = knob;

/* ---- the page ---------------------------------------------------------------------------------------------- */

if (typeof document === "object") document.addEventListener("DOMContentLoaded", () => {
  const form = document.getElementById("knob"), time = form.elements.time;
  const WIDTH = 360, HEIGHT = 200, LEFT = 46, BELOW = 36, TOP = 20;
  const COLOURS = ["#0072b2", "#d55e00", "#009e73"], DASHES = ["none", "7 4", "2 4"];

  const element = (name, attributes, text) => {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    return made;
  };
  const line = (points, attributes) => element("polyline", {points: points.map(p => p.map(x => x.toFixed(2)).join()).join(" "),
    fill: "none", "stroke-width": 1.8, ...attributes});
  const rounded = x => String(Number(x.toPrecision(3)));

  /* What turns a point within the limits into a place of a picture of that size; of the plane where its scales are one. */
  function scaled(svg, [left, right], [low, high], one, [width, height] = [WIDTH, HEIGHT]) {
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    let [wide, tall] = [(width - LEFT - 10)/(right - left), (height - TOP - BELOW)/(high - low)];
    if (one) wide = tall = Math.min(wide, tall);
    return ([x, y]) => [LEFT + wide*(x - left), height - BELOW - tall*(y - low)];
  }

  /* Axes with titles, and a line at each of the heights. */
  function axes(svg, place, xs, ys, [across, upward]) {
    const [left, right] = [xs[0], xs[xs.length - 1]], low = Math.min(...ys);
    for (const x of xs) {
      svg.append(element("text", {x: place([x, low])[0], y: place([x, low])[1] + 16, "text-anchor": "middle"}, rounded(x)));
    }
    for (const y of ys) {
      svg.append(line([place([left, y]), place([right, y])], {stroke: "currentColor", opacity: y === 0 ? 0.6 : 0.2}));
      svg.append(element("text", {x: LEFT - 5, y: place([left, y])[1] + 4, "text-anchor": "end"}, rounded(y)));
    }
    svg.append(element("text", {x: place([(left + right)/2, low])[0], y: place([left, low])[1] + 31, "text-anchor": "middle",
      class: "axis"}, across), element("text", {x: 2, y: 12, class: "axis"}, upward));
  }

  function curves(svg, {times, seen}, names, now) {
    const values = seen.flatMap(each => names.map(name => each[name])), t = times[times.length - 1];
    let [low, high] = [Math.min(0, ...values), Math.max(0, ...values)];
    if (high - low < 1e-9) [low, high] = [-1, 1];
    const place = scaled(svg, [0, t], [low, high]);
    axes(svg, place, [0, t/2, t], [low, low*high < 0 ? 0 : (low + high)/2, high], [svg.dataset.across, svg.dataset.upward]);
    names.forEach((name, k) => svg.append(line(seen.map(each => place([each.t, each[name]])),
      {stroke: COLOURS[k], "stroke-dasharray": DASHES[k], "data-curve": name})));
    svg.append(line([[place([now, 0])[0], TOP], [place([now, 0])[0], HEIGHT - BELOW]], {stroke: "currentColor", opacity: 0.5}));
  }

  /* Singular times and the circle within which the series converges, at the scale of the circle. */
  function plane(svg, found, radius) {
    const limit = found.length ? 1.5*radius : 3, ends = [-limit, limit];
    const place = scaled(svg, ends, ends, true), [x, y] = place([0, 0]), [edge] = place([radius, 0]);
    axes(svg, place, [-limit, 0, limit], [-limit, 0, limit], [svg.dataset.across, svg.dataset.upward]);
    if (found.length) {
      svg.append(element("circle", {cx: x, cy: y, r: edge - x, fill: COLOURS[0], "fill-opacity": 0.15, stroke: COLOURS[0]}));
    }
    for (const [re, im] of found) for (const sign of [1, -1]) {
      const [p, q] = place([re, sign*im]);
      svg.append(line([[p - 4, q - 4], [p + 4, q + 4]], {stroke: COLOURS[1]}), line([[p - 4, q + 4], [p + 4, q - 4]], {stroke: COLOURS[1]}));
    }
  }

  /* The system as its file draws it, at one of the samples. */
  function picture(svg, {seen}, now) {
    const shapes = each => {
      const found = drawing.evaluate(drawing.inputs.map(name => each[name] ?? 0));
      return DATA.shapes.map((_, i) => drawing.outputs.flatMap((name, k) => name.startsWith(`drawing[${i + 1},`) ? [found[k]] : []));
    };
    const pairs = numbers => numbers.flatMap((x, k) => k % 2 ? [] : [[x, numbers[k + 1]]]);
    const all = seen.map(shapes), last = DATA.shapes.length - 1;
    /* The view follows the surfaces and the particle; the rest of the path is cut off. */
    const close = all[now].filter((numbers, i) => numbers.length > 6 || i === last).flatMap(pairs);
    const extent = k => {
      const found = close.map(p => p[k]), low = Math.min(...found), high = Math.max(...found), room = 0.4*(high - low) + 0.3;
      return [low - room, high + room];
    };
    const place = scaled(svg, extent(0), extent(1), true, [2*WIDTH, 1.7*HEIGHT]);
    svg.append(line(all.map(each => place(each[last])), {stroke: COLOURS[1], opacity: 0.5}));
    DATA.shapes.forEach((shape, i) => {
      const places = pairs(all[now][i]).map(place);
      svg.append(shape === "point" ? element("circle", {cx: places[0][0], cy: places[0][1], r: 5, fill: COLOURS[1]})
        : line(places, {stroke: places.length > 3 ? COLOURS[0] : "currentColor"}));
    });
  }

  const settings = () => Object.fromEntries([...new FormData(form)].map(([name, value]) => [name, name === "law" ? value : Number(value)]));
  let followed;

  function show() {
    const now = Number(time.value), seen = followed.seen[now];
    for (const output of form.querySelectorAll("output")) {
      const shown = {...settings(), ...seen, radius: followed.radius}[output.name];
      output.value = shown === Infinity ? "∞" : Math.abs(shown) < 1e-9 ? "0" : rounded(shown);
    }
    for (const svg of document.querySelectorAll("svg[data-curves]")) curves(svg, followed, svg.dataset.curves.split(" "), seen.t);
    picture(document.getElementById("picture"), followed, now);
  }

  /* Announce the settings to a screen reader when a change has ended. */
  function announce() {
    const status = form.querySelector("[role=status]");
    status.textContent = status.dataset.text.replace(/\{(\w+)\}/g, (_, name) => form.elements[name].value);
  }

  function turn() {
    const given = settings();
    followed = {...knob.follow(given), radius: knob.radius(given)};
    for (const label of form.querySelectorAll("label[data-law]")) label.hidden = label.dataset.law !== given.law;
    time.max = followed.seen.length - 1;
    plane(document.getElementById("plane"), knob.singularities(given), followed.radius);
    show();
  }

  const play = form.elements.play;
  let timer = 0;

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
