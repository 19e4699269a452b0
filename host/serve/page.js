'use strict';
// Shows a rendering: asks for its status every half second, and for the pixels of a layer when they are new.
const at = id => document.getElementById(id), page = document.body;
const canvas = at('canvas'), frame = at('frame'), sheet = document.createElement('canvas');
const SHARES = [['chains', 'chains', '#c9a86a'], ['pool', 'pool', '#6f9bb5'], ['paths', 'path tracing', '#7f9f7f'],
  ['bidirectional', 'bidirectional path tracing', '#a985a9']];
let status = null, pixels = null, faults = 0, zoom = 0, centre = [0.5, 0.5]; // zoom: screen per picture pixel; 0: fits
const views = {}; // exposure of each layer

addEventListener('error', fault);
addEventListener('unhandledrejection', fault);
addEventListener('securitypolicyviolation', fault);
function fault() { page.dataset.faults = ++faults; }

// ---- numbers as text

function time(seconds) {
  if (seconds === null || !isFinite(seconds)) return '–';
  const s = Math.round(seconds), two = n => String(n).padStart(2, '0');
  return seconds < 10 ? seconds.toFixed(1) + ' s' : s < 60 ? s + ' s'
    : s < 3600 ? Math.floor(s / 60) + ':' + two(s % 60)
    : Math.floor(s / 3600) + ':' + two(Math.floor(s / 60) % 60) + ':' + two(s % 60);
}
function rate(value) {
  for (const [unit, size] of [['G', 1e9], ['M', 1e6], ['k', 1e3]])
    if (value >= size) return (value / size).toPrecision(3) + ' ' + unit;
  return value ? value.toPrecision(3) + ' ' : '0 ';
}
function percent(value) { return (100 * value).toPrecision(2) + ' %'; }

// ---- pixels: bits of 16-bit floats, 3 per pixel

const VALUE = new Float32Array(65536); // of all 16-bit floats
for (let bits = 0; bits < 65536; ++bits) {
  const exponent = bits >> 10 & 31, fraction = bits & 1023, sign = bits & 32768 ? -1 : 1;
  VALUE[bits] = sign * (exponent === 31 ? (fraction ? NaN : Infinity)
    : exponent ? (1 + fraction / 1024) * 2 ** (exponent - 15) : fraction * 2 ** -24);
}

const CURVES = {
  srgb: v => encoded(v),
  soft: v => encoded(v < 0.5 ? v : 1 - 0.25 / v), // continuous, with its slope
  film: v => encoded(v * (2.51 * v + 0.03) / (v * (2.43 * v + 0.59) + 0.14)), // Narkowicz 2016, a fit to ACES
  linear: v => v,
};
function encoded(v) { return v <= 0.0031308 ? 12.92 * v : 1.055 * v ** (1 / 2.4) - 0.055; }

// The byte on the screen of every 16-bit float.
function bytes() {
  const table = new Uint8ClampedArray(65536), layer = at('layer').value, gain = 2 ** at('exposure').value;
  const curve = CURVES[at('curve').value], signed = layer === 'normal', size = layer === 'difference';
  for (let bits = 0; bits < 65536; ++bits) {
    const v = VALUE[bits] * gain;
    table[bits] = signed ? 127.5 + 127.5 * v : 255 * curve(Math.max(0, size ? Math.abs(v) : v));
  }
  return table;
}

function develop() {
  if (!pixels) return;
  const { width, height, bits } = pixels, table = bytes();
  sheet.width = width;
  sheet.height = height;
  const context = sheet.getContext('2d'), image = context.createImageData(width, height), out = image.data;
  let lit = 0;
  for (let i = 0, o = 0; i < bits.length; i += 3, o += 4) {
    out[o] = table[bits[i]];
    out[o + 1] = table[bits[i + 1]];
    out[o + 2] = table[bits[i + 2]];
    out[o + 3] = 255;
    lit += out[o] + out[o + 1] + out[o + 2] > 24;
  }
  context.putImageData(image, 0, 0);
  page.dataset.lit = (3 * lit / bits.length).toFixed(3);
  draw();
}

// Stops that make the brightest but a hundredth of the values white.
function auto() {
  if (!pixels) return;
  const values = [];
  for (let i = 0; i < pixels.bits.length; i += 7) {
    const v = Math.abs(VALUE[pixels.bits[i]]);
    if (v < Infinity) values.push(v);
  }
  values.sort((a, b) => a - b);
  const white = values[Math.floor(0.99 * values.length)];
  expose(white > 0 ? -Math.log2(white) : 0);
}
function expose(stops) {
  const shown = Math.min(10, Math.max(-10, Math.round(10 * stops) / 10));
  at('exposure').value = shown;
  at('stops').textContent = (shown > 0 ? '+' : '') + shown.toFixed(1);
  views[at('layer').value] = shown;
  develop();
}

// ---- the view

// Screen pixels per pixel of the picture, and where its upper left corner is.
function place() {
  const dpr = devicePixelRatio || 1, w = frame.clientWidth * dpr, h = frame.clientHeight * dpr;
  const fits = Math.min(w / status.width, h / status.height), scale = zoom || fits;
  const slack = (screen, size, c) => size * scale <= screen ? (screen - size * scale) / 2
    : Math.min(0, Math.max(screen - size * scale, screen / 2 - c * size * scale));
  return { w, h, fits, scale, x: slack(w, status.width, centre[0]), y: slack(h, status.height, centre[1]) };
}
function draw() {
  if (!pixels || !status) return;
  if (matchMedia('(max-width: 760px)').matches) // the page scrolls: as high as the picture is at this width
    frame.style.height = Math.min(innerHeight * 0.6, frame.clientWidth * status.height / status.width) + 'px';
  else
    frame.style.height = '';
  const p = place(), context = canvas.getContext('2d');
  canvas.width = p.w;
  canvas.height = p.h;
  context.imageSmoothingEnabled = p.scale < 1;
  context.imageSmoothingQuality = 'high';
  context.drawImage(sheet, p.x, p.y, status.width * p.scale, status.height * p.scale);
}
function level() {
  return Math.max(0, Math.min(8, Math.floor(-Math.log2(place().scale) + 0.01)));
}
// The picture's pixel under the pointer.
function under(event) {
  const dpr = devicePixelRatio || 1, box = frame.getBoundingClientRect(), p = place();
  return [((event.clientX - box.left) * dpr - p.x) / p.scale, ((event.clientY - box.top) * dpr - p.y) / p.scale];
}
function zoomAt(event, factor) {
  const p = place(), [x, y] = under(event);
  const scale = Math.min(64, Math.max(p.fits, p.scale * factor));
  const dpr = devicePixelRatio || 1, box = frame.getBoundingClientRect();
  centre = [(x - ((event.clientX - box.left) * dpr - p.w / 2) / scale) / status.width,
            (y - ((event.clientY - box.top) * dpr - p.h / 2) / scale) / status.height];
  zoom = scale > p.fits * 1.001 ? scale : 0;
  draw();
}
function tell(event) {
  if (!pixels || !status) return;
  const [x, y] = under(event).map(Math.floor), side = 2 ** pixels.level;
  const i = 3 * (Math.floor(y / side) * pixels.width + Math.floor(x / side));
  const inside = x >= 0 && y >= 0 && x < status.width && y < status.height && i < pixels.bits.length;
  at('pixel').textContent = inside ? `${x}, ${y} · ` : '\u00a0';
  if (!inside) return;
  const values = document.createElement('b');
  values.textContent = [0, 1, 2].map(c => VALUE[pixels.bits[i + c]].toPrecision(4)).join('  ');
  at('pixel').append(values, side > 1 ? ` · mean of ${side} × ${side} pixels` : '');
}

const pointers = new Map();
frame.addEventListener('pointerdown', e => { frame.setPointerCapture(e.pointerId); pointers.set(e.pointerId, e); });
for (const end of ['pointerup', 'pointercancel']) frame.addEventListener(end, e => pointers.delete(e.pointerId));
frame.addEventListener('pointermove', e => {
  tell(e);
  const before = pointers.get(e.pointerId);
  if (!before || !status) return;
  const others = [...pointers.values()].filter(p => p.pointerId !== e.pointerId);
  if (others.length === 1) {
    const apart = p => Math.hypot(p.clientX - others[0].clientX, p.clientY - others[0].clientY);
    zoomAt({ clientX: (e.clientX + others[0].clientX) / 2, clientY: (e.clientY + others[0].clientY) / 2 },
           apart(e) / Math.max(1, apart(before)));
  } else if (zoom) {
    const p = place(), dpr = devicePixelRatio || 1;
    centre = [(p.w / 2 - p.x - (e.clientX - before.clientX) * dpr) / (status.width * p.scale),
              (p.h / 2 - p.y - (e.clientY - before.clientY) * dpr) / (status.height * p.scale)];
    draw();
  }
  pointers.set(e.pointerId, e);
});
frame.addEventListener('wheel', e => { e.preventDefault(); if (status) zoomAt(e, 1.2 ** (-Math.sign(e.deltaY))); }, { passive: false });
frame.addEventListener('pointerdown', tell);
at('fit').onclick = () => { zoom = 0; draw(); };
at('one').onclick = () => { zoom = 1; draw(); };
at('auto').onclick = auto;
at('zero').onclick = () => expose(0);
at('exposure').oninput = () => expose(+at('exposure').value);
at('curve').onchange = develop;
at('layer').onchange = () => { pixels = null; expose(views[at('layer').value] || 0); };
new ResizeObserver(draw).observe(frame);
addEventListener('resize', draw);

// ---- figures

function list(id, rows) {
  at(id).replaceChildren(...rows.flatMap(([name, value]) => {
    const term = document.createElement('dt'), figure = document.createElement('dd');
    term.textContent = name;
    figure.textContent = value;
    return [term, figure];
  }));
}
function layersShow() {
  const select = at('layer'), known = [...select.options].map(o => o.value);
  for (const name of status.layers)
    if (!known.includes(name)) select.add(new Option(name === 'difference' ? 'difference of halves' : name, name));
}
function sharesShow() {
  const total = SHARES.reduce((sum, [key]) => sum + Math.max(0, status.weights[key]), 0);
  at('shares').hidden = !(total > 0);
  if (!(total > 0)) return;
  const parts = SHARES.map(([key, name, color]) => [name, color, Math.max(0, status.weights[key]) / total]);
  at('bar').replaceChildren(...parts.map(([, color, part]) => {
    const piece = document.createElement('span');
    piece.style.cssText = `background:${color};width:${100 * part}%`;
    return piece;
  }));
  at('legend').replaceChildren(...parts.map(([name, color, part]) => {
    const entry = document.createElement('span'), mark = document.createElement('i');
    mark.style.background = color;
    entry.append(mark, `${name} ${Math.round(100 * part)} %`);
    return entry;
  }));
}

// The line through the later half of the points, of log error against log time: [slope, error at a time].
function trend(points) {
  const used = points.slice(points.length >> 1).map(([t, e]) => [Math.log(t), Math.log(e)]), n = used.length;
  const mean = i => used.reduce((sum, p) => sum + p[i], 0) / n, mx = mean(0), my = mean(1);
  const sxx = used.reduce((sum, p) => sum + (p[0] - mx) ** 2, 0), sxy = used.reduce((sum, p) => sum + (p[0] - mx) * (p[1] - my), 0);
  return { slope: sxy / sxx, error: t => Math.exp(my + sxy / sxx * (Math.log(t) - mx)) };
}
function shape(name, attributes, text) {
  const element = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const key in attributes) element.setAttribute(key, attributes[key]);
  if (text) element.textContent = text;
  return element;
}
function chartShow(points, line, end) {
  const times = [points[0][0], Math.max(end, points[points.length - 1][0])], last = times[1];
  const errors = points.map(p => p[1]).concat(line ? line.error(last) : []);
  const low = Math.min(...errors), high = Math.max(...errors);
  const x = t => 6 + 288 * Math.log(t / times[0]) / Math.log(last / times[0]);
  const y = e => 14 + 94 * (high > low ? Math.log(high / e) / Math.log(high / low) : 0.5);
  const path = list => 'M' + list.map(([t, e]) => x(t).toFixed(1) + ' ' + y(e).toFixed(1)).join('L');
  const now = points[points.length - 1];
  at('chart').replaceChildren(
    shape('path', { d: 'M6 112H294', stroke: '#333', fill: 'none' }),
    shape('path', { d: path(points), stroke: '#c9a86a', 'stroke-width': 1.5, fill: 'none' }),
    ...line ? [shape('path', { d: path([now, [last, line.error(last)]]), stroke: '#8c8c8c', 'stroke-dasharray': '3 3', fill: 'none' })] : [],
    shape('circle', { cx: x(now[0]), cy: y(now[1]), r: 2.5, fill: '#c9a86a' }),
    shape('text', { x: 6, y: 10 }, percent(points[0][1])),
    shape('text', { x: 6, y: 126 }, time(times[0])),
    shape('text', { x: 294, y: 126, 'text-anchor': 'end' }, time(last)));
}
function errorShow() {
  const points = status.errors, some = points.length > 1, halves = status.layers.includes('halfB');
  at('chart').toggleAttribute('hidden', !some);
  if (!some) {
    at('forecast').textContent = halves ? 'Measured from the halves after a few passes.'
      : 'Not known: it is measured from two independent halves, which this rendering does not make (--layers=halves, with mmlt).';
    return;
  }
  const now = points[points.length - 1][1], line = points.length >= 4 ? trend(points) : null;
  const falls = line && line.slope < -0.1, end = status.left === null ? 0 : status.elapsed + status.left;
  chartShow(points, falls ? line : null, end);
  let text = `${percent(now)} in the means of 8 × 8 pixels`;
  if (falls && !status.ended) {
    if (end > status.elapsed) text += `; about ${percent(line.error(end))} at the end`;
    text += `; half of it in about ${time(status.elapsed * (2 ** (-1 / line.slope) - 1))}`;
  }
  at('forecast').textContent = text + '.';
}

function statusShow() {
  const s = status;
  document.title = s.image + ' – Twinlight';
  at('image').textContent = s.image;
  at('about').textContent = `${s.scene} · ${s.integrator} · ${s.width} × ${s.height}`;
  at('state').textContent = s.ended ? `done in ${time(s.elapsed)}`
    : `${Math.floor(100 * s.fraction)} %${s.left === null ? '' : ' · ' + time(s.left) + ' left'}`;
  at('done').style.width = 100 * (s.ended ? 1 : s.fraction) + '%';
  list('figures', [['time', time(s.elapsed)], ['samples per pixel', s.samples_per_pixel.toPrecision(4)],
                   ['samples', rate(s.samples_per_second) + '/s'], ['rays', rate(s.rays_per_second) + '/s']]);
  list('devices', s.devices.map(d => [d.name, rate(d.rays_per_second) + 'rays/s']));
  layersShow();
  sharesShow();
  errorShow();
  page.dataset.state = s.ended ? 'ended' : s.version > 0 ? 'rendering' : 'waiting';
  page.dataset.version = s.version;
}

// ---- asking

async function pixelsAsk() {
  const layer = at('layer').value, wanted = level(), same = pixels && pixels.layer === layer && pixels.level === wanted;
  const reply = await fetch(`picture?layer=${layer}&level=${wanted}&after=${same ? pixels.version : 0}`);
  if (reply.status !== 200) return;
  const header = name => +reply.headers.get(name), bits = new Uint16Array(await reply.arrayBuffer());
  if (layer !== at('layer').value) return;
  const first = !pixels && !(layer in views);
  pixels = { layer, level: wanted, width: header('X-Width'), height: header('X-Height'), version: header('X-Version'), bits };
  if (first && layer !== 'picture' && layer !== 'normal' && layer !== 'albedo') auto();
  else develop();
}
async function ask() {
  let lost = false;
  try {
    const reply = await fetch('status.json');
    const next = await reply.json();
    status = next;
    if (next.version > 0) statusShow();
    await pixelsAsk();
  } catch (error) {
    if (!(error instanceof TypeError)) throw error; // fetch's own: the program has ended
    lost = true;
  }
  if (lost && page.dataset.state !== 'ended') {
    page.dataset.state = 'lost';
    at('state').textContent = status ? 'the program has ended or cannot be reached' : 'not reached';
  }
  setTimeout(ask, lost ? 2000 : status.ended ? 250 : 500);
}
ask();
