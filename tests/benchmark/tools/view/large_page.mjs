// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node large_page.mjs PROGRAM PACKAGES FOLDER [BIRDS FRAMES]: how long the live page of a large flock
// takes to open, to show a frame that it has never shown and one that it has, and for how long it is
// held while somebody drags (`tools/view_times`). FOLDER is made where it is missing, and kept.

import { createReadStream, createWriteStream, existsSync, mkdirSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { once } from 'node:events';

import { loadPage, openBrowser, openWindow, run, serve, until } from '../../../tools/view/browser/harness.mjs';

const [program, packages, folder, ...size] = process.argv.slice(2);
const [birds = 1000, frames = 10000] = size.map(Number);
const JUMPS = 40;
const REST = 400; // ms between jumps, as somebody who looks for a moment
const SETTLED = 3000; // ms after which a new window of the browser has nothing more to do
const FPS = 30;

// A box whose room for each bird is that of 80 in 28 x 28 x 13 m, and a camera that sees it all.
function sceneOf() {
  const half = Math.round(14 * Math.cbrt(birds / 80));
  const high = half;
  return `[scene]
seed = 3
duration = ${(frames - 0.5) / FPS}
fps = ${FPS}
warmup = 5
box = [[${-half}, ${-half}, 6], [${half}, ${half}, ${6 + high}]]

[[species]]
name = "bird"
count = ${birds}
wingspan = 0.5
body_length = 0.25
wingbeat_hz = 7
speed = 9
model = "boids"

[species.parameters]
d_s = 2.5
d_v = 8
alpha_s = 2
alpha_c = 0.15
alpha_a = 0.7
alpha_b = 12
s_min = 6
s_max = 12
wall_taper = 6
noise = 2

[camera]
fov = 50
position = [0, ${-3.5 * half}, 1.7]
look_at = [0, 0, ${6 + high / 2}]
`;
}

// What a reconstruction has and a simulation lacks: how sure each depth is.
async function addDepthErrors(from, to) {
  const out = createWriteStream(to);
  let text = '';
  for await (const line of createInterface({ input: createReadStream(from) })) {
    text += line + (line.startsWith('#') ? '' : line.startsWith('frame') ? ',sd_depth' : ',0.8') + '\n';
    if (text.length < 1 << 20) continue;
    if (!out.write(text)) await once(out, 'drain');
    text = '';
  }
  out.end(text);
  await once(out, 'finish');
}

async function makeRun() {
  const aside = folder + '.part';
  rmSync(aside, { recursive: true, force: true });
  mkdirSync(aside, { recursive: true });
  const scene = join(aside, 'scene.toml');
  writeFileSync(scene, sceneOf());
  console.log(`making ${birds} birds x ${frames} frames in ${folder} ..`);
  run(program, ['simulate', scene, '--no-video', '--out', join(aside, 'truth'), '--quiet']);
  renameSync(join(aside, 'truth/tracks_true.csv'), join(aside, 'tracks.csv'));
  renameSync(join(aside, 'truth/camera.yaml'), join(aside, 'camera.yaml'));
  await addDepthErrors(join(aside, 'truth/trajectories.csv'), join(aside, 'trajectories.csv'));
  rmSync(join(aside, 'truth'), { recursive: true });
  renameSync(aside, folder);
}

if (!existsSync(folder)) await makeRun();

// The time from the start of the program until the flock is in sight, in a window that `prepare`
// has opened or is to open now. What a browser does for a new window of its own comes to a second of
// both cores.
async function timeOpening(what, prepare) {
  const start = performance.now();
  const server = await serve(program, [folder]);
  const served = performance.now();
  const { page, complaints } = await loadPage(await prepare(), server.address);
  await until('the flock', () => page.evaluate(() => document.querySelector('.flight canvas')?.dataset.frame > 0));
  const seen = performance.now();
  const asked = await page.evaluate(() => performance.timeOrigin) - performance.timeOrigin;
  console.log(`${what}: server after ${(served - start).toFixed(0)} ms, its address asked for after ` +
    `${(asked - start).toFixed(0)}, the flock in sight after ${(seen - start).toFixed(0)}`);
  return { server, page, complaints };
}

const browser = await openBrowser(packages);
const first = await timeOpening('opened in a new window', () => openWindow(browser));
await first.server.stop();
await first.page.context().close();
const window = await openWindow(browser);
await new Promise((resolve) => setTimeout(resolve, SETTLED));
const { server, page, complaints } = await timeOpening('opened in a browser that is open', () => window);

// In the page: goes to each frame and waits until all of it is drawn.
const jump = (list, rest) => page.evaluate(async ([to, pause]) => {
  const { run } = window.flocklift;
  if (!window.timed) {
    window.timed = { frame: 0 };
    run.clock.onDraw(() => {
      const { frame } = run.clock;
      if (run.boxes.at(frame) && run.flock().at(frame)) window.timed.frame = frame;
    });
  }
  const next = () => new Promise((resolve) => requestAnimationFrame(resolve));
  const out = [];
  for (const frame of to) {
    await new Promise((resolve) => setTimeout(resolve, pause));
    const begin = performance.now();
    run.clock.go(frame);
    while (window.timed.frame !== frame) await next();
    await next(); // it is on the screen
    out.push(performance.now() - begin);
  }
  return out;
}, [list, rest]);

function say(what, jumps) {
  const times = [...jumps].sort((a, b) => a - b);
  const at = (share) => times[Math.min(Math.floor(share * times.length), times.length - 1)].toFixed(0);
  const worst = jumps.indexOf(times[times.length - 1]) + 1;
  console.log(`${what}: median ${at(0.5)}, 90 % ${at(0.9)}, worst ${at(1)} ms (the ${worst}. of ${jumps.length})`);
}
// The same places each time, spread over the film.
const places = (salt) => Array.from({ length: JUMPS }, (_, k) =>
  1 + Math.floor((((k + 1) * 0.618033988 + salt) % 1) * (frames - 1)));

async function scrub(what) {
  const held = await page.evaluate(async (last) => {
    const { run } = window.flocklift;
    const next = () => new Promise((resolve) => requestAnimationFrame(resolve));
    let worst = 0, pause = 0;
    let then = performance.now();
    let fresh = then, drawn = window.timed.frame;
    for (let k = 0; k < 240; k++) {
      run.clock.go(1 + Math.round((last - 1) * (0.5 - 0.5 * Math.cos((k / 240) * 2 * Math.PI))));
      await next();
      const now = performance.now();
      worst = Math.max(worst, now - then);
      if (window.timed.frame !== drawn) {
        pause = Math.max(pause, now - fresh);
        fresh = now;
        drawn = window.timed.frame;
      }
      then = now;
    }
    return { worst, pause };
  }, frames);
  console.log(`${what}: longest held ${held.worst.toFixed(0)} ms, longest without a new frame ${held.pause.toFixed(0)} ms`);
}

say('first jumps, files being read', await jump(places(0), REST));
say('the same again', await jump(places(0), REST));
await scrub('dragging, files being read');
await until('the end of reading', () => page.evaluate(() => window.flocklift.run.store.get().reading === ''));
say('first jumps, files read', await jump(places(0.37), REST));
say('the same again', await jump(places(0.37), REST));
say('without a rest', await jump(places(0.71), 0));
await scrub('dragging, files read');
if (complaints.length > 0) throw new Error(complaints.join('; '));
await server.stop();
await browser.close();
