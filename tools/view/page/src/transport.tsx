// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Play, step, scrub, loop, speed; and above the slider where tracks may be wrong.

import { useEffect, useRef } from 'preact/hooks';

import { flatContext } from './graphics';
import { useNews } from './news';
import type { Run } from './run';
import { useValue } from './state';
import type { Suspect } from './types';

export const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 4];

function drawDoubt(canvas: HTMLCanvasElement, run: Run, suspects: Suspect[], dark: boolean): void {
  const g = flatContext(canvas);
  canvas.width = canvas.clientWidth * devicePixelRatio;
  canvas.height = canvas.clientHeight * devicePixelRatio;
  const length = Math.max(run.clock.end - run.clock.first, 1);
  for (const { frame, doubt } of suspects) {
    const x = ((frame - run.clock.first) / length) * canvas.width;
    const h = Math.max(doubt, 0.12) * canvas.height;
    g.fillStyle = `rgba(${dark ? '255, 138, 76' : '213, 94, 0'}, ${0.25 + 0.75 * doubt})`;
    g.fillRect(x - devicePixelRatio, canvas.height - h, 2 * devicePixelRatio, h);
  }
}

function DoubtStrip({ run }: { run: Run }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const suspects = useNews(run, () => run.suspects);
  const dark = useValue(run.store, (s) => s.dark);
  useEffect(() => {
    const element = canvas.current;
    if (!element) return undefined;
    const resize = new ResizeObserver(() => drawDoubt(element, run, suspects, dark));
    resize.observe(element);
    return () => resize.disconnect();
  }, [suspects, dark]);
  return <canvas class="doubt" ref={canvas} title="where tracks may be wrong" />;
}

export function Transport({ run }: { run: Run }) {
  const { store, clock } = run;
  const frame = useValue(store, (s) => s.frame);
  const playing = useValue(store, (s) => s.playing);
  const speed = useValue(store, (s) => s.speed);
  const loop = useValue(store, (s) => s.loop);
  const time = ((frame - 1) / clock.fps).toFixed(2);
  return (
    <div class="transport">
      <button title="one frame back (left)" onClick={() => clock.step(-1)}>‹</button>
      <button class="play" title="play or pause (space)" aria-label={playing ? 'pause' : 'play'}
        onClick={() => store.set({ playing: !playing })}>
        {playing ? '❚❚' : '▶'}
      </button>
      <button title="one frame on (right)" onClick={() => clock.step(1)}>›</button>
      <div class="scrub">
        <DoubtStrip run={run} />
        <input type="range" aria-label="frame" min={clock.first} max={clock.end} value={frame}
          onInput={(e) => {
            store.set({ playing: false });
            clock.go(Number(e.currentTarget.value));
          }} />
      </div>
      <span class="time" title="frame of all frames, and the time">
        {frame} / {clock.end} <small>{time} s</small>
      </span>
      <select aria-label="speed" value={speed}
        onChange={(e) => store.set({ speed: Number(e.currentTarget.value) })}>
        {SPEEDS.map((s) => <option value={s}>{s}×</option>)}
      </select>
      <button class={loop ? 'on' : ''} title="over and over (O)" aria-pressed={loop}
        onClick={() => store.set({ loop: !loop })}>⟳</button>
    </div>
  );
}
