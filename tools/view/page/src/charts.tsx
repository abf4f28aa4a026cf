// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Curves over time with the cursor of the pictures: the flock's median, and the chosen animal.

import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';

import { colourOf, ground } from './colours';
import { Plots, type PlotInfo } from './plots';
import type { Run } from './run';
import { noSeries } from './source';
import { useValue } from './state';
import type { Series } from './types';

type Curve = 'depth' | 'speed' | 'neighbour' | 'polarisation';
const CURVES: [Curve, PlotInfo][] = [
  ['depth', { name: 'depth [m]' }],
  ['speed', { name: 'speed [m/s]' }],
  ['neighbour', { name: 'nearest neighbour [m]' }],
  ['polarisation', { name: 'polarisation', y: [-0.02, 1.05] }],
];

// Both series on the union of their frames.
function align(flock: Series, one: Series, curve: Curve): uPlot.AlignedData {
  const frames = [...new Set([...flock.frames, ...one.frames])].sort((a, b) => a - b);
  const spread = (s: Series) => {
    const at = new Map(s.frames.map((f, k) => [f, s[curve][k]]));
    return frames.map((f) => (at.has(f) ? at.get(f) : undefined)) as (number | null)[];
  };
  return [frames, spread(flock), spread(one)];
}

export function Charts({ run }: { run: Run }) {
  const host = useRef<HTMLDivElement>(null);
  const dark = useValue(run.store, (s) => s.dark);

  useEffect(() => {
    const element = host.current;
    if (!element) return;
    let flock = noSeries();
    let one = noSeries();
    // Above the plots, which need not be drawn again when it moves.
    const placeCursor = (u: uPlot) => {
      const cursor = u.over.querySelector<HTMLElement>('.now');
      if (cursor) cursor.style.transform = `translateX(${u.valToPos(run.store.get().frame, 'x')}px)`;
    };
    const addCursor = (u: uPlot) => {
      u.over.append(Object.assign(document.createElement('i'), { className: 'now' }));
      placeCursor(u);
      const go = (event: PointerEvent) => {
        if (event.buttons !== 1) return;
        const box = u.over.getBoundingClientRect();
        run.store.set({ playing: false });
        run.clock.go(u.posToVal(event.clientX - box.left, 'x'));
      };
      u.over.addEventListener('pointerdown', go);
      u.over.addEventListener('pointermove', go);
    };
    const plots = new Plots(element, CURVES.map(([, info]) => info), dark,
      [
        { stroke: ground(dark).ink, width: 1.4, points: { show: false }, spanGaps: true },
        { stroke: () => colourOf(Math.max(run.store.get().selected, 0), dark), width: 1.6,
          points: { show: false } },
      ],
      {
        cursor: { x: false, y: false, points: { show: false }, drag: { x: false, y: false } },
        scales: { x: { range: () => [run.clock.first, run.clock.end] } },
        hooks: { draw: [placeCursor], ready: [addCursor] },
      },
      'Curves of depth, speed, distance and order come with the trajectories.');
    const fill = () => plots.set(CURVES.map(([curve]) => align(flock, one, curve)));
    let asked = '';
    let askedFlock = '';
    const ask = async () => {
      const state = run.store.get();
      const { after, curves } = run.versions;
      const nowFlock = `${state.table} ${after} ${curves}`;
      const now = `${nowFlock} ${state.selected}`;
      if (now === asked) return;
      asked = now;
      try {
        if (nowFlock !== askedFlock) {
          askedFlock = nowFlock;
          flock = await run.source.series(state.table, -1);
        }
        const chosen =
          state.selected < 0 ? noSeries() : await run.source.series(state.table, state.selected);
        if (asked === now) one = chosen;
        fill();
      } catch (error) {
        run.store.fail(error);
      }
    };
    void ask();
    const stops = [
      run.store.watch((state, before) => {
        if (state.frame !== before.frame) plots.plots.forEach(placeCursor);
        if (state.selected !== before.selected || state.table !== before.table) void ask();
      }),
      run.watch(() => void ask()),
    ];
    return () => {
      stops.forEach((stop) => stop());
      plots.destroy();
    };
  }, [dark]);

  return <div class="charts" ref={host} />;
}
