// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// node answers.mjs PROGRAM SCRATCH: how soon the server of the live page tells of a solve and ends it,
// and how many looks a second it sends of a large running scene (`tools/view_times`). No browser.

import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';

import { run, serve } from '../../../tools/view/browser/harness.mjs';

const [program, scratch] = process.argv.slice(2);
const SOLVES = 20;
const WATCHED = 10000; // ms
const AGENTS = 10000;
const TICKS = 100; // of the kernel's clock in a second, in /proc
rmSync(scratch, { recursive: true, force: true });
mkdirSync(scratch, { recursive: true });

const sceneOf = (count, seconds, fps, half, high, back) => `[scene]
seed = 7
duration = ${seconds}
fps = ${fps}
substeps = 1
box = [[${-half}, ${-half}, 4], [${half}, ${half}, ${4 + high}]]
[[species]]
name = "bird"
count = ${count}
wingspan = 0.7
speed = 8
model = "boids"
[camera]
fov = 50
position = [0, ${-back}, 1.7]
look_at = [0, 0, ${4 + high / 2}]
`;

// The boxes of a simulated flock, off by a third of a pixel: the same ones each time.
function makeRun(birds, frames) {
  const folder = join(scratch, `${birds}x${frames}`);
  writeFileSync(folder + '.toml', sceneOf(birds, (frames - 0.5) / 30, 30, 10, 12, 42));
  run(program, ['simulate', folder + '.toml', '--no-video', '--out', folder + '.truth', '--quiet']);
  mkdirSync(folder);
  copyFileSync(join(folder + '.truth', 'camera.yaml'), join(folder, 'camera.yaml'));
  let state = 1;
  const uniform = () => (state = (state * 48271) % 2147483647) / 2147483647;
  const noise = () => 0.3 * Math.sqrt(-2 * Math.log(uniform())) * Math.cos(2 * Math.PI * uniform());
  const rows = readFileSync(join(folder + '.truth', 'tracks_true.csv'), 'utf8').trim().split('\n');
  writeFileSync(join(folder, 'tracks.csv'), rows.map((row) => {
    const cells = row.split(',');
    if (/^\d/.test(row)) for (let k = 2; k < 6; k++) cells[k] = (Number(cells[k]) + noise()).toFixed(3);
    return cells.join(',');
  }).join('\n') + '\n');
  return folder;
}

// Calls `take` with each piece of news of the solver.
async function hear(address, take) {
  let text = '';
  const decoder = new TextDecoder();
  try {
    for await (const piece of (await fetch(address + 'api/events')).body) {
      text += decoder.decode(piece, { stream: true });
      const events = text.split('\n\n');
      text = events.pop();
      for (const event of events) {
        const [, data] = event.match(/^event: solve\ndata: (.*)$/) ?? [];
        if (data) take(JSON.parse(data), performance.now());
      }
    }
  } catch {
    // the server has ended
  }
}

const words = (times) => {
  const sorted = [...times].sort((a, b) => a - b);
  return `${sorted[sorted.length >> 1].toFixed(0)} ms (worst ${sorted[sorted.length - 1].toFixed(0)})`;
};

async function timeSolves(birds, frames) {
  const server = await serve(program, [makeRun(birds, frames)]);
  const { address } = server;
  const { solve } = await (await fetch(address + 'api/session')).json();
  const body = JSON.stringify({ ...solve.values, wingspan: '0.7,0.05' });
  let take = () => undefined;
  void hear(address, (news, when) => take(news, when));
  const heard = [], done = [];
  for (let k = 0; k < SOLVES; k++) {
    await new Promise((resolve) => setTimeout(resolve, 200));
    const asked = performance.now();
    let first = 0;
    const ended = new Promise((resolve) => {
      take = (news, when) => {
        first ||= when;
        if (news.state === 'done' || news.state === 'failed') resolve({ news, when });
      };
    });
    const answer = await fetch(address + 'api/solve', { method: 'POST', body,
      headers: { 'Content-Type': 'application/json', Origin: new URL(address).origin } });
    if (!answer.ok) throw new Error(await answer.text());
    const { news, when } = await ended;
    if (news.state === 'failed') throw new Error(news.text);
    heard.push(first - asked);
    done.push(when - asked);
  }
  console.log(`a solve of ${birds} birds x ${frames} frames: heard of after ${words(heard)}, done after ${words(done)}`);
  await server.stop();
}

async function timeLooks() {
  const scene = join(scratch, 'large.toml');
  writeFileSync(scene, sceneOf(AGENTS, 60, 60, 70, 70, 245));
  const server = await serve(program, [scene, '--threads', '1']);
  const used = () => {
    const fields = readFileSync(`/proc/${server.pid}/stat`, 'utf8').split(') ')[1].split(' ');
    return (1000 * (Number(fields[11]) + Number(fields[12]))) / TICKS; // user and system [ms]
  };
  let bytes = 0, start = 0, before = 0;
  for await (const piece of (await fetch(server.address + 'api/live')).body) {
    if (start === 0) {
      start = performance.now();
      before = used();
    }
    bytes += piece.length;
    if (performance.now() - start > WATCHED) break;
  }
  const seconds = (performance.now() - start) / 1000;
  const looks = bytes / (32 + 18 * AGENTS);
  console.log(`${AGENTS} boids: ${(looks / seconds).toFixed(1)} looks a second, ` +
    `${((used() - before) / looks).toFixed(1)} ms of processor time each, with its step`);
  await server.stop();
}

await timeSolves(5, 200);
await timeSolves(50, 300);
await timeLooks();
