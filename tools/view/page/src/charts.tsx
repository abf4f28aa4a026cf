// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Curves over time with the cursor of the pictures: the flock's median, and the chosen animal.

import { useEffect, useRef } from 'preact/hooks';
import uPlot from 'uplot';

import { colourOf, ground } from './colours';
import type { Run } from './run';
import { noSeries } from './source';
import { useValue } from './state';
import type { Series } from './types';

type Curve = 'depth' | 'speed' | 'neighbour' | 'polarisation';
const CURVES: [Curve, string][] = [
  ['depth', 'depth [m]'],
  ['speed', 'speed [m/s]'],
  ['neighbour', 'nearest neighbour [m]'],
  ['polarisation', 'polarisation'],
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
    element.textContent = '';
    let flock = noSeries();
    let one = noSeries();
    const colours = ground(dark);
    const size = () => ({
      width: Math.max(Math.floor(element.clientWidth / CURVES.length) - 6, 80),
      height: Math.max(element.clientHeight, 60),
    });
    const fontSize = Math.round(parseFloat(getComputedStyle(element).fontSize) * 0.85);
    const font = `${fontSize}px system-ui, sans-serif`;
    // Above the plots, which need not be drawn again when it moves.
    const placeCursor = (u: uPlot) => {
      const cursor = u.over.querySelector<HTMLElement>('.now');
      if (cursor) cursor.style.transform = `translateX(${u.valToPos(run.store.get().frame, 'x')}px)`;
    };
    const plots = CURVES.map(([curve, label]) => {
      const axis = { stroke: colours.ink, grid: { stroke: colours.grid, width: 1 }, font,
        ticks: { show: false } };
      const cell = document.createElement('div');
      cell.className = 'chart';
      const title = document.createElement('span');
      title.textContent = label;
      cell.append(title);
      element.append(cell);
      return new uPlot(
        {
          ...size(),
          legend: { show: false },
          cursor: { x: false, y: false, points: { show: false }, drag: { x: false, y: false } },
          scales: {
            x: { time: false, range: () => [run.clock.first, run.clock.end] },
            y: curve === 'polarisation' ? { range: [-0.02, 1.05] } : {},
          },
          padding: [fontSize * 2.1, fontSize, 0, 0],
          axes: [
            { ...axis, size: fontSize * 1.9, space: 60 },
            { ...axis, size: fontSize * 3.4, space: 28 },
          ],
          series: [
            {},
            { stroke: colours.ink, width: 1.4, points: { show: false }, spanGaps: true },
            { stroke: () => colourOf(Math.max(run.store.get().selected, 0), dark), width: 1.6,
              points: { show: false } },
          ],
          hooks: {
            draw: [placeCursor],
            ready: [
              (u) => {
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
              },
            ],
          },
        },
        align(flock, one, curve),
        cell,
      );
    });
    const fill = () => CURVES.forEach(([curve], k) => plots[k].setData(align(flock, one, curve)));
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
        if (state.frame !== before.frame) plots.forEach(placeCursor);
        if (state.selected !== before.selected || state.table !== before.table) void ask();
      }),
      run.watch(() => void ask()),
    ];
    const resize = new ResizeObserver(() => plots.forEach((plot) => plot.setSize(size())));
    resize.observe(element);
    return () => {
      resize.disconnect();
      stops.forEach((stop) => stop());
      plots.forEach((plot) => plot.destroy());
    };
  }, [dark]);

  return <div class="charts" ref={host} />;
}
