// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Asks what there is to show, and shows it.

import '../node_modules/lil-gui/dist/lil-gui.css'; // not among its exports
import 'uplot/dist/uPlot.min.css';
import './style.css';

import { render } from 'preact';

import { listen } from './api';
import { Run } from './run';
import { RunPage } from './runPage';
import { ScenePage } from './scenePage';
import { source, type Source } from './source';
import { Store } from './state';
import { applyTheme, systemIsDark } from './theme';
import type { Edits, Reading, SolveNews, Versions } from './types';

const store = new Store({
  mode: 'look', frame: 1, playing: false, speed: 1, loop: true, selected: -1, second: -1,
  hovered: -1, hidden: new Set(), solo: false, view: 'orbit', table: 'before', ghost: 'none',
  boxes: true, ids: false, trails: 30, bars: true, grid: true, birdScale: 1, panel: true,
  help: false, gone: false, message: '', reading: '',
  faults: [], dark: systemIsDark(),
});

function listenTo(run: Run): void {
  listen({
    data: (versions: Versions) => run.setVersions(versions),
    edits: (edits: Edits) => run.setEdits(edits),
    solve: (news: SolveNews) => run.setSolve(news),
    suspects: () => void run.askSuspects().catch((error: unknown) => store.fail(error)),
    reading: (news: Reading) => store.set({ reading: news.text, faults: news.faults }),
  }, (gone) => store.set({ gone }));
}

function showRun(source: Source, root: HTMLElement): void {
  const { session } = source;
  store.set({ frame: session.frames.first,
    table: session.versions.after > 0 ? 'after' : 'before' });
  const run = new Run(source, store);
  // The server's reading behind the scenes begins when it is listened to.
  if (!session.exported) void run.clock.drawn.then(() => listenTo(run));
  // What the first pictures need is under way while the page is built.
  run.flock().at(session.frames.first);
  if (session.has.boxes) run.boxes.at(session.frames.first);
  render(<RunPage run={run} />, root);
}

function start(root: HTMLElement): void {
  applyTheme(store);
  const shown = source();
  const session = 'session' in shown ? shown.session : shown;
  document.title = `${session.name} – flocklift`;
  if ('session' in shown) return showRun(shown, root);
  store.set({ mode: 'steer', playing: true, trails: 12 });
  render(<ScenePage session={shown} store={store} />, root);
}

const root = document.getElementById('app') as HTMLElement;
try {
  start(root);
} catch (error) {
  root.innerHTML = '';
  const p = document.createElement('p');
  p.className = 'fatal';
  p.textContent = `The page cannot start: ${error instanceof Error ? error.message : String(error)}.`;
  root.append(p);
}
