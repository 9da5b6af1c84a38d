// The page of `dapple converge`: draws what the data element holds. Sections: numbers as text, series, plots, tables,
// images, and what joins them. State lives in `state` alone; whatever changes it calls `update`.
'use strict';

const data = JSON.parse(document.getElementById('data').textContent);
const byId = (id) => document.getElementById(id);
const state = {
  scene: 0,
  measure: data.measures[0].key,
  hidden: new Set(),                  // names of contenders
  layout: 'grid', content: 'picture',
  moment: null,                       // index into the times of the scene's pictures
  left: 'reference', right: null,     // of the pair
  view: {zoom: 1, x: 0.5, y: 0.5},    // of all images: magnification, and the point in the middle as shares
};
const scene = () => data.scenes[state.scene];
const measure = () => data.measures.find((m) => m.key === state.measure);
const shown = () => scene().contenders.filter((c) => !state.hidden.has(c.name));

function element(tag, properties = {}, ...children) {
  const node = Object.assign(document.createElement(tag), properties);
  node.append(...children);
  return node;
}
function svg(tag, attributes = {}, ...children) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  node.append(...children);
  return node;
}

// --- Numbers as text

const superscript = (n) => String(n).replace(/[-\d]/g, (c) => (c === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[c]));
function formatError(value) {
  if (value === null || !isFinite(value)) return '–';
  if (value === 0) return '0';
  if (value >= 0.001 && value < 1000) return String(Number(value.toPrecision(3)));
  const exponent = Math.floor(Math.log10(value) + 1e-12);
  return `${(value / 10 ** exponent).toFixed(2)}·10${superscript(exponent)}`;
}
function formatTick(value) {
  const exponent = Math.floor(Math.log10(value) + 1e-9), digit = Math.round(value / 10 ** exponent);
  if (exponent >= -2 && exponent <= 3) return String(Number(value.toPrecision(2)));
  return (digit === 1 ? '' : digit + '·') + '10' + superscript(exponent);
}
function formatSeconds(value) {
  if (value === null) return '–';
  if (value < 0.001) return '< 1 ms';
  if (value < 1) return `${Number((1000 * value).toPrecision(2))} ms`;
  if (value < 120) return `${Number(value.toPrecision(3))} s`;
  if (value < 7200) return `${Number((value / 60).toPrecision(2))} min`;
  if (value < 172800) return `${Number((value / 3600).toPrecision(2))} h`;
  return `${Number((value / 86400).toPrecision(2))} days`;
}
const formatFactor = (value) => `${value < 10 ? value.toFixed(2) : Number(value.toPrecision(3))} ×`;
const formatSlope = (slope) => {
  if (!slope) return '–';
  const text = slope.slope.toFixed(2).replace('-', '−');
  return slope.halfWidth === null ? text : `${text} ± ${slope.halfWidth.toFixed(2)}`;
};

// --- Series: a colour, a dash and a marker for each name, the same in all scenes

const names = [...new Set(data.scenes.flatMap((s) => s.contenders.map((c) => c.name)))];
const dashes = ['', '9 5', '2.5 4', '12 4 2.5 4', '5 3', '14 5'];
const shapes = [
  'M0-5A5 5 0 1 1 0 5A5 5 0 1 1 0-5Z', 'M-4.5-4.5H4.5V4.5H-4.5Z', 'M0-6L5.5 4.5H-5.5Z', 'M0-6L6 0 0 6-6 0Z',
  'M0 6L5.5-4.5H-5.5Z', 'M-2-6H2V-2H6V2H2V6H-2V2H-6V-2H-2Z', 'M-5-3L-3-5 0-2 3-5 5-3 2 0 5 3 3 5 0 2-3 5-5 3-2 0Z',
];
function style(name) {
  const i = names.indexOf(name);
  return {color: `var(--s${i % 7})`, dash: dashes[i % dashes.length], shape: shapes[i % shapes.length]};
}
function key(name) {
  const {color, dash, shape} = style(name);
  return svg('svg', {class: 'key', viewBox: '0 0 34 14', style: `color:${color}`},
             svg('path', {d: 'M0 7H34', 'stroke-dasharray': dash}),
             svg('path', {d: shape, class: 'mark', transform: 'translate(17 7) scale(.9)'}));
}

// --- Plots

const margin = {left: 58, top: 14, bottom: 42}, plotHeight = 400;
margin.right = Math.min(190, 20 + 7.9 * Math.max(...names.map((name) => name.length)));  // the names stand there

function logScale(low, high, from, to) {
  const a = Math.log(low), b = Math.log(high);
  return (value) => from + (Math.log(value) - a) / (b - a) * (to - from);
}
function ticks(low, high) {
  const result = [], few = Math.log10(high / low) < 2.6;
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e) {
    for (let d = 1; d < 10; ++d) {
      const value = d * 10 ** e;
      if (value >= low * 0.9999 && value <= high * 1.0001)
        result.push({value, isDecade: d === 1, isLabelled: d === 1 || (few && (d === 2 || d === 5))});
    }
  }
  return result;
}
// Of what is drawn: the errors of all that are shown, and the reference's own where it is not far below.
function extent(series, axis) {
  const points = series.flatMap((c) => c.curve);
  const xs = points.map((p) => p[axis]);
  const ys = points.flatMap((p) => [p.low[state.measure], p.high[state.measure]]).filter((y) => y > 0);
  if (!ys.length) return null;
  const own = referenceError();
  let yLow = Math.min(...ys);
  if (own && own > yLow / 30) yLow = Math.min(yLow, own);
  return {x: [Math.min(...xs) / 1.1, Math.max(...xs) * 1.1], y: [yLow / 1.6, Math.max(...ys) * 1.3]};
}
function referenceError() {
  const errors = scene().reference.errors;
  return errors ? errors[state.measure] : null;
}

function drawPlot(host, axis) {
  host.replaceChildren();
  const series = shown().filter((c) => c.curve.length);
  const range = extent(series, axis);
  if (!range) return host.append(element('p', {className: 'note', textContent: 'Nothing to draw.'}));
  const width = Math.max(320, host.clientWidth);
  const box = {left: margin.left, right: width - margin.right, top: margin.top, bottom: plotHeight - margin.bottom};
  const x = logScale(...range.x, box.left, box.right), y = logScale(...range.y, box.bottom, box.top);
  const picture = svg('svg', {viewBox: `0 0 ${width} ${plotHeight}`, height: plotHeight, role: 'img',
                              'aria-label': `${measure().name} against ${axis}`});
  drawAxes(picture, box, range, x, y, axis);
  drawBand(picture, box, y);
  drawGuide(picture, box, range, series, x, y, axis);
  const marks = series.flatMap((c) => drawSeries(picture, c, x, y, axis));
  drawNames(picture, box, series, y);
  addHover(picture, box, marks);
  host.append(picture);
}
function drawAxes(picture, box, range, x, y, axis) {
  for (const t of ticks(...range.x)) {
    picture.append(svg('path', {d: `M${x(t.value)} ${box.top}V${box.bottom}`, class: t.isDecade ? 'decade' : 'grid'}));
    if (t.isLabelled) picture.append(text(x(t.value), box.bottom + 18, formatTick(t.value), 'middle'));
  }
  for (const t of ticks(...range.y)) {
    picture.append(svg('path', {d: `M${box.left} ${y(t.value)}H${box.right}`, class: t.isDecade ? 'decade' : 'grid'}));
    if (t.isLabelled) picture.append(text(box.left - 8, y(t.value) + 4, formatTick(t.value), 'end'));
  }
  picture.append(text((box.left + box.right) / 2, plotHeight - 6, axis === 'seconds' ? 'seconds' : 'passes', 'middle'));
}
function text(x, y, content, anchor, className = '') {
  const node = svg('text', {x, y, 'text-anchor': anchor, class: className});
  node.textContent = content;
  return node;
}
function drawBand(picture, box, y) {
  const own = referenceError();
  if (!own || y(own) > box.bottom) return;
  const top = Math.max(box.top, y(own));
  picture.append(svg('rect', {x: box.left, y: top, width: box.right - box.left, height: box.bottom - top, class: 'band'}),
                 svg('path', {d: `M${box.left} ${top}H${box.right}`, class: 'band-edge'}),
                 text(box.left + 6, Math.min(top + 15, box.bottom - 4), 'the reference’s own error', 'start', 'band-name'));
}
// How the error of independent samples falls: squares by 1/n, absolute differences by its root.
function drawGuide(picture, box, range, series, x, y, axis) {
  const isSquare = /mse/i.test(state.measure), exponent = isSquare ? -1 : -0.5;
  const last = series.map((c) => c.curve.at(-1)).sort((a, b) => a.mean[state.measure] - b.mean[state.measure])[0];
  const [x0, x1] = range.x;
  const at = (value) => last.mean[state.measure] * (value / last[axis]) ** exponent;
  const start = Math.max(x0, last[axis] * (range.y[1] / last.mean[state.measure]) ** (1 / exponent));
  const end = Math.min(x1, last[axis] * (range.y[0] / last.mean[state.measure]) ** (1 / exponent));
  const label = (isSquare ? '∝ 1/' : '∝ 1/√') + (axis === 'seconds' ? 't' : 'n');
  const line = (share) => start * (end / start) ** share;
  picture.append(svg('path', {d: `M${x(start)} ${y(at(start))}L${x(end)} ${y(at(end))}`, class: 'guide'}));
  // Written above the line at its left end or below it at its right one, where there is more room.
  const places = [
    {x: x(line(0.08)) + 4, y: Math.max(y(at(line(0.08))) - 6, box.top + 12), anchor: 'start'},
    {x: x(line(0.92)) - 4, y: Math.min(y(at(line(0.92))) + 15, box.bottom - 4), anchor: 'end'},
  ];
  const points = series.flatMap((c) => c.curve.map((p) => [x(p[axis]), y(p.mean[state.measure])]));
  const room = (place) => Math.min(...points.map(([px, py]) => Math.hypot(px - place.x, py - place.y)));
  const best = room(places[0]) > room(places[1]) ? places[0] : places[1];
  picture.append(text(best.x, best.y, label, best.anchor));
}
function drawSeries(picture, contender, x, y, axis) {
  const {color, dash, shape} = style(contender.name);
  const points = contender.curve.filter((p) => p.mean[state.measure] > 0);
  const line = (side) => points.map((p) => `${x(p[axis])} ${y(p[side][state.measure])}`);
  const group = svg('g', {class: 'series', style: `color:${color}`, 'data-name': contender.name});
  if (contender.seeds.length > 1)
    group.append(svg('path', {class: 'range', d: `M${line('high').join('L')}L${line('low').reverse().join('L')}Z`}));
  group.append(svg('path', {class: 'curve', d: `M${line('mean').join('L')}`, 'stroke-dasharray': dash}));
  const marks = points.map((point) => {
    const px = x(point[axis]), py = y(point.mean[state.measure]);
    const node = svg('path', {d: shape, class: 'mark', transform: `translate(${px} ${py}) scale(.75)`});
    group.append(node);
    return {contender, point, px, py, node};
  });
  picture.append(group);
  return marks;
}
// At the right end of each curve, pushed apart where they would touch.
function drawNames(picture, box, series, y) {
  const labels = series.map((c) => ({name: c.name, y: y(c.curve.at(-1).mean[state.measure]) + 4})).sort((a, b) => a.y - b.y);
  for (let i = 1; i < labels.length; ++i) labels[i].y = Math.max(labels[i].y, labels[i - 1].y + 15);
  const over = labels.length ? labels.at(-1).y - (box.bottom - 2) : 0;
  for (const label of labels) {
    const node = text(box.right + 6, label.y - Math.max(0, over), label.name, 'start', 'name');
    picture.append(svg('g', {class: 'series', style: `color:${style(label.name).color}`}, node));
  }
}
function addHover(picture, box, marks) {
  const cross = svg('path', {class: 'cross'});
  picture.prepend(cross);
  let near = null;
  const leave = () => {
    if (near) near.node.classList.remove('is-near');
    near = null;
    cross.removeAttribute('d');
    byId('tip').hidden = true;
  };
  picture.addEventListener('pointermove', (event) => {
    const place = picture.getBoundingClientRect(), factor = picture.viewBox.baseVal.width / place.width;
    const px = (event.clientX - place.left) * factor, py = (event.clientY - place.top) * factor;
    leave();
    const distance = (m) => Math.hypot(m.px - px, m.py - py);
    near = marks.reduce((best, m) => (!best || distance(m) < distance(best) ? m : best), null);
    if (!near) return;
    near.node.classList.add('is-near');
    cross.setAttribute('d', `M${near.px} ${box.top}V${box.bottom}M${box.left} ${near.py}H${box.right}`);
    showTip(near, event);
  });
  picture.addEventListener('pointerleave', leave);
}
function showTip({contender, point}, event) {
  const k = state.measure, rows = [
    [measure().name, formatError(point.mean[k])], ['time', formatSeconds(point.seconds)],
    ['passes', String(Number(point.passes.toPrecision(3)))],
  ];
  if (contender.seeds.length > 1) rows.splice(1, 0, [`of ${contender.seeds.length} seeds`, `${formatError(point.low[k])} – ${formatError(point.high[k])}`]);
  const list = element('dl', {}, ...rows.flatMap(([a, b]) => [element('dt', {textContent: a}), element('dd', {textContent: b, style: 'margin:0;text-align:right'})]));
  const tip = byId('tip');
  tip.replaceChildren(element('b', {textContent: contender.name, style: `color:${style(contender.name).color}`}), list);
  tip.hidden = false;
  const w = tip.offsetWidth, h = tip.offsetHeight;
  tip.style.left = `${Math.min(event.clientX + 16, innerWidth - w - 8)}px`;
  tip.style.top = `${Math.max(8, event.clientY - h - 12)}px`;
}

// --- Tables

const lastError = (contender, k = state.measure) => (contender.curve.length ? contender.curve.at(-1).mean[k] : null);
function bestError(contenders) {
  return Math.min(...contenders.map((c) => lastError(c)).filter((e) => e !== null));
}
function row(tag, cells) {
  return element('tr', {}, ...cells.map((cell) => {
    const node = element(tag);
    node.append(...(Array.isArray(cell) ? cell : [cell]));
    return node;
  }));
}
function timeText(time, slope) {
  if (!time || time.kind === 'never') return [slope ? 'never at this slope' : 'not in this time'];
  if (time.kind === 'extrapolated') return [`≈ ${formatSeconds(time.seconds)}`, element('small', {textContent: 'extrapolated'})];
  return [(time.kind === 'atMost' ? '≤ ' : '') + formatSeconds(time.seconds)];
}
function drawTable() {
  const list = [...scene().contenders].sort((a, b) => (lastError(a) ?? Infinity) - (lastError(b) ?? Infinity));
  const best = bestError(list), seconds = scene().seconds;
  const body = element('tbody');
  for (const c of list) {
    const error = lastError(c), point = c.curve.at(-1), slopes = c.slopes[state.measure];
    const cells = [[key(c.name), ` ${c.name}`]];
    if (error === null) cells.push('–', '–', '–', '–', '–', '–', '–');
    else {
      const k = state.measure, mean = (f) => c.seeds.reduce((sum, run) => sum + f(run), 0) / c.seeds.length;
      cells.push([formatError(error), element('small', {textContent: c.seeds.length > 1 ? `${formatError(point.low[k])} – ${formatError(point.high[k])}` : ''})],
                 formatFactor(error / best), timeText(c.timeToBest[k], slopes.time), formatSlope(slopes.time), formatSlope(slopes.passes),
                 String(Math.round(point.passes)), formatSeconds(mean((run) => run.prepareSeconds)));
    }
    const line = row('td', cells);
    line.replaceChild(element('th', {}, ...line.firstChild.childNodes), line.firstChild);
    line.firstChild.scope = 'row';
    if (error === best) line.children[1].firstChild.replaceWith(element('span', {className: 'best', textContent: formatError(error)}));
    body.append(line);
  }
  const head = element('thead', {}, row('th', ['', `error after ${formatSeconds(seconds)}`, 'over the best', 'time to the best’s error',
                                                'slope over time', 'slope over passes', 'passes', 'preparation']));
  byId('table').replaceChildren(head, body);
  const count = Math.max(...list.map((c) => c.seeds.length));
  byId('table-note').textContent = `${measure().name}; ${count === 1 ? 'one seed' : `mean, least and greatest of ${count} seeds`}; slopes of the logarithms${count > 1 ? ' with their 95 % interval over the seeds' : ''}`;
}
function drawScoreboard() {
  byId('overview').hidden = data.scenes.length < 2;
  if (data.scenes.length < 2) return;
  const body = element('tbody'), factors = new Map(names.map((name) => [name, []]));
  data.scenes.forEach((s, i) => {
    const best = bestError(s.contenders);
    const cells = [s.name, ...names.map((name) => {
      const c = s.contenders.find((one) => one.name === name), error = c ? lastError(c) : null;
      if (error === null) return '–';
      factors.get(name).push(error / best);
      return [element('span', {className: error === best ? 'best' : '', textContent: formatError(error)}),
              element('small', {textContent: error === best ? 'best' : formatFactor(error / best)})];
    })];
    const line = row('td', cells);
    line.addEventListener('click', () => selectScene(i));
    body.append(line);
  });
  const mean = (list) => (list.length ? formatFactor(Math.exp(list.reduce((sum, f) => sum + Math.log(f), 0) / list.length)) : '–');
  const sum = row('td', ['over the best, geometric mean', ...names.map((name) => mean(factors.get(name)))]);
  sum.className = 'sum';
  body.append(sum);
  const heads = ['', ...names.map((name) => [key(name), ` ${name}`])];
  byId('scoreboard').replaceChildren(element('thead', {}, row('th', heads)), body);
  byId('overview-note').textContent = `${measure().name} after ${formatSeconds(data.scenes[0].seconds)}; click a scene for its curves`;
}

// --- Images

const pictures = () => scene().pictures;
function moments() {
  return [...new Set(pictures().contenders.flat().map((p) => p.timeIndex))].sort((a, b) => a - b);
}
// The latest picture of a contender up to a moment; null where its first pass had not ended.
function pictureOf(index, moment) {
  return pictures().contenders[index].filter((p) => p.timeIndex <= moment).at(-1) ?? null;
}
function imageOf(name) {
  if (name === 'reference') return {name, source: pictures().reference, note: scene().reference.source};
  const index = scene().contenders.findIndex((c) => c.name === name), list = moments();
  const picture = pictureOf(index, list[state.moment]);
  if (!picture) return {name, source: null, note: ''};
  const point = scene().contenders[index].seeds[0].snapshots.find((s) => s.timeIndex === picture.timeIndex);
  return {name, source: picture[state.content], note: `${formatError(point.errors[state.measure])} · ${picture.passes} ${picture.passes === 1 ? 'pass' : 'passes'}`};
}
function pane(...images) {
  const view = element('div', {className: 'view', style: `aspect-ratio:${scene().width}/${scene().height}`});
  for (const image of images) {
    if (image.source) view.append(element('img', {src: image.source, alt: `${image.name}, ${state.content}`, draggable: false}));
    else view.append(element('div', {className: 'none', textContent: 'no pass has ended yet'}));
  }
  addMoves(view);
  const title = images.map((image) => image.name).join(' | ');
  const note = images.length === 1 ? images[0].note : '';
  const caption = element('figcaption', {}, element('b', {textContent: title}), element('span', {textContent: note, title: note}));
  return element('figure', {className: 'pane'}, caption, view);
}
function drawImages() {
  byId('hint').textContent = `${state.layout === 'pair' ? 'Move over the image to divide it; drag' : 'Drag'} to move, turn the wheel to zoom, double-click to fit${state.layout === 'pair' ? '.' : ': all images move together.'}`;
  const stage = byId('stage'), isPair = state.layout === 'pair', list = moments();
  byId('images').hidden = !list.length;
  if (!list.length) return;
  const slider = byId('moment');
  slider.max = list.length - 1;
  slider.value = state.moment;
  const times = pictures().contenders.flat().filter((p) => p.timeIndex === list[state.moment]).map((p) => p.seconds);
  byId('moment-text').textContent = formatSeconds(Math.max(...times));
  slider.closest('label').hidden = list.length < 2;
  byId('pair').hidden = !isPair;
  byId('scale').hidden = state.content !== 'difference';
  stage.classList.toggle('is-pair', isPair);
  if (isPair) {
    const figure = pane(imageOf(state.left), imageOf(state.right));
    figure.querySelector('.view').append(element('div', {className: 'rule'}));
    stage.replaceChildren(figure);
  } else {
    const panes = ['reference', ...shown().map((c) => c.name)].map((name) => pane(imageOf(name)));
    stage.style.setProperty('--columns', panes.length < 5 ? panes.length : panes.length === 5 || panes.length === 6 ? 3 : 4);
    stage.replaceChildren(...panes);
  }
  moveImages();
  moveDivider();
}
function moveImages() {
  const {zoom, x, y} = state.view;
  for (const image of document.querySelectorAll('.view img')) {
    image.style.transform = `translate(${100 * (0.5 - x * zoom)}%, ${100 * (0.5 - y * zoom)}%) scale(${zoom})`;
    image.classList.toggle('is-near', zoom > 1.5);
  }
  byId('zoom').querySelector('output').textContent = `${Number(zoom.toPrecision(2))}×`;
}
function moveDivider() {
  if (state.layout !== 'pair') return;
  const share = Number(byId('divider').value), view = byId('stage').querySelector('.view');
  const [first, second] = [...view.children];
  first.style.zIndex = 1;
  view.querySelector('.rule').style.cssText = `left:${share}%;z-index:2`;
  // The clip is in the image's own pixels, which zoom and move with it.
  const {zoom, x} = state.view, inImage = 100 * (x + (share / 100 - 0.5) / zoom);
  if (first.tagName === 'IMG') first.style.clipPath = `inset(0 ${100 - Math.min(100, Math.max(0, inImage))}% 0 0)`;
  if (second.tagName === 'IMG') second.style.zIndex = 0;
}
function setView(zoom, x, y) {
  const z = Math.min(32, Math.max(1, zoom)), half = 0.5 / z;
  const inside = (value) => Math.min(1 - half, Math.max(half, value));
  state.view = {zoom: z, x: inside(x), y: inside(y)};
  moveImages();
  moveDivider();
}
function addMoves(view) {
  view.addEventListener('wheel', (event) => {
    event.preventDefault();
    const place = view.getBoundingClientRect(), {zoom, x, y} = state.view;
    const dx = (event.clientX - place.left) / place.width - 0.5, dy = (event.clientY - place.top) / place.height - 0.5;
    const next = Math.min(32, Math.max(1, zoom * Math.exp(-event.deltaY / 400)));
    setView(next, x + dx / zoom - dx / next, y + dy / zoom - dy / next);  // what is under the pointer stays there
  }, {passive: false});
  view.addEventListener('pointerdown', (event) => view.setPointerCapture(event.pointerId));
  view.addEventListener('pointermove', (event) => {
    const place = view.getBoundingClientRect(), {zoom, x, y} = state.view;
    if (!view.hasPointerCapture(event.pointerId)) {
      if (state.layout !== 'pair') return;
      byId('divider').value = 100 * (event.clientX - place.left) / place.width;
      return moveDivider();
    }
    setView(zoom, x - event.movementX / place.width / zoom, y - event.movementY / place.height / zoom);
  });
  view.addEventListener('dblclick', () => setView(1, 0.5, 0.5));
}

// --- What joins them

function segments(host, entries, current, choose) {
  host.replaceChildren(...entries.map(([value, label]) => {
    const button = element('button', {type: 'button', textContent: label, onclick: () => choose(value)});
    button.dataset.value = value;
    button.setAttribute('aria-pressed', value === current);
    return button;
  }));
}
function drawControls() {
  segments(byId('scenes'), data.scenes.length < 2 ? [] : data.scenes.map((s, i) => [i, s.name]), state.scene, selectScene);
  segments(byId('measures'), data.measures.map((m) => [m.key, m.name]), state.measure, (k) => update({measure: k}));
  segments(byId('layout'), [['grid', 'Side by side'], ['pair', 'Slider']], state.layout, (layout) => update({layout}));
  segments(byId('content'), [['picture', 'Pictures'], ['difference', 'Differences']], state.content, (content) => update({content}));
  byId('definition').textContent = `${measure().name[0].toUpperCase()}${measure().name.slice(1)}: ${measure().definition}; t: test, r: reference.`;
  byId('legend').replaceChildren(...scene().contenders.map((c) => {
    const button = element('button', {type: 'button', title: 'Show or hide', onclick: () => toggle(c.name)}, key(c.name), c.name);
    button.dataset.name = c.name;
    button.setAttribute('aria-pressed', !state.hidden.has(c.name));
    return button;
  }));
  for (const side of ['left', 'right']) {
    const options = ['reference', ...scene().contenders.map((c) => c.name)].map((name) => element('option', {value: name, textContent: name}));
    byId(side).replaceChildren(...options);
    byId(side).value = state[side];
  }
}
function toggle(name) {
  if (!state.hidden.delete(name)) state.hidden.add(name);
  update();
}
function selectScene(index) {
  state.scene = Number(index);
  const best = [...scene().contenders].sort((a, b) => (lastError(a) ?? Infinity) - (lastError(b) ?? Infinity))[0];
  Object.assign(state, {moment: Math.max(0, moments().length - 1), left: 'reference', right: best.name, view: {zoom: 1, x: 0.5, y: 0.5}});
  update();
}
function drawTexts() {
  const s = scene(), about = data.about, own = referenceError();
  const seeds = Math.max(...s.contenders.map((c) => c.seeds.length));
  document.title = `${data.scenes.length > 1 ? `${data.scenes.length} scenes` : s.name}: convergence`;
  byId('title').textContent = s.name;
  byId('summary').textContent = `${s.width} × ${s.height} pixels, ${formatSeconds(s.seconds)} for each of ${s.contenders.length} contenders, ${seeds} ${seeds === 1 ? 'seed' : 'seeds'} each, ${about.processor}, ${about.threads} threads.`;
  const least = Math.min(...s.contenders.flatMap((c) => c.curve.map((p) => p.mean[state.measure])));
  byId('band-note').textContent = own
    ? `The reference’s own ${measure().name} is ${formatError(own)} (${s.reference.errorSource}). Below it, and close to it, a curve tells of the reference, not of the algorithm; slopes leave out what is less than four times that.`
    : `The reference’s own ${measure().name} is not known (${s.reference.errorSource}); the least that was measured, ${formatError(least)}, bounds it only if the algorithm that reached it shares no bias with it.`;
  const runs = s.contenders.flatMap((c) => c.seeds);
  const cost = runs.length ? Math.max(...runs.map((run) => run.snapshotSeconds / run.seconds)) : 0;
  const facts = [
    ['Scene', s.file], ['Reference', s.reference.source], ['Program', `Dapple ${about.version}, ${about.instructionSet}`],
    ['Machine', `${about.processor}, ${about.processors} processors, ${about.threads} threads`], ['Date', about.date],
    ['Clock', `Preparation and passes; it stands still while snapshots are taken, which took at most ${(100 * cost).toFixed(2)} % of a run. Measuring comes after the run.`],
    ['Slopes', 'Snapshots of one run are correlated, so each seed gives one slope (least squares on the logarithms); the interval is Student’s over the seeds.'],
    ['Extrapolated', 'A time beyond the run goes on along the fitted slope; it is a guess, and blind to bias that stays.'],
  ];
  byId('facts').replaceChildren(...facts.flatMap(([a, b]) => [element('dt', {textContent: a}), element('dd', {textContent: b})]));
  byId('command').textContent = about.commandLine;
}
function drawPlots() {
  drawPlot(byId('plot-time'), 'seconds');
  drawPlot(byId('plot-passes'), 'passes');
}
function update(change = {}) {
  Object.assign(state, change);
  byId('tip').hidden = true;
  drawControls();
  drawTexts();
  drawScoreboard();
  drawPlots();
  drawTable();
  drawImages();
}
function setTheme(isDark) {
  document.documentElement.style.colorScheme = isDark ? 'dark' : 'light';
  byId('theme').textContent = isDark ? '☀ Light' : '☾ Dark';
  byId('theme').onclick = () => setTheme(!isDark);
}
function start() {
  byId('moment').addEventListener('input', (event) => update({moment: Number(event.target.value)}));
  byId('divider').addEventListener('input', moveDivider);
  for (const side of ['left', 'right']) byId(side).addEventListener('change', (event) => update({[side]: event.target.value}));
  const zoomBy = (factor) => setView(state.view.zoom * factor, state.view.x, state.view.y);
  const button = (id, label, title, onclick) => element('button', {type: 'button', id, textContent: label, title, onclick});
  byId('zoom').append(button('zoom-out', '−', 'Zoom out', () => zoomBy(0.5)), element('output', {style: 'min-width:3em;text-align:center;align-self:center'}),
                      button('zoom-in', '+', 'Zoom in', () => zoomBy(2)), button('zoom-fit', 'Fit', 'Show all', () => setView(1, 0.5, 0.5)));
  const ramp = data.ramp.map((color, i) => `${color} ${100 * i / (data.ramp.length - 1)}%`).join(', ');
  byId('scale').querySelector('i').style.background = `linear-gradient(90deg, ${ramp})`;
  const system = matchMedia('(prefers-color-scheme: dark)');
  byId('theme').textContent = system.matches ? '☀ Light' : '☾ Dark';
  byId('theme').onclick = () => setTheme(!system.matches);
  let width = innerWidth;
  addEventListener('resize', () => {
    if (innerWidth !== width) drawPlots();
    width = innerWidth;
  });
  selectScene(0);
}
start();
