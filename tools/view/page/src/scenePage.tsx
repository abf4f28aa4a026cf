// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The page of a running scene.

import { useEffect, useMemo, useRef, useState } from 'preact/hooks';

import { getJson, post } from './api';
import { Crosshair } from './crosshair';
import { Help } from './help';
import { listenToKeys, type Key } from './keys';
import { watchLive } from './live';
import type { Parts } from './later';
import { LiveSeries } from './liveSeries';
import { Notices } from './notices';
import { NO_WEBGL, askForCard, type Means } from './graphics';
import { useValue, type Store, type ViewName } from './state';
import { bringParts } from './parts';
import { steer } from './steer';
import { SwarmView } from './swarm';
import { ThemeButton, flipTheme } from './theme';
import type { SceneSession } from './types';
import { VIEWS, ViewButtons, moveKeys } from './viewButtons';

const PACES = [0.1, 0.25, 0.5, 1, 2, 4];
const MOUSE: [string, string][] = [
  ['click', 'a point that attracts everybody'],
  ['drag a goal', 'moves it; the way to it follows'],
  ['drag a predator', 'moves it'],
  ['drag', 'turn (right button: move, wheel: zoom)'],
  ['drag while sketching', 'a way that leads everybody'],
];

export function ScenePage({ session, store }: { session: SceneSession; store: Store }) {
  const canvas = useRef<HTMLCanvasElement>(null);
  const swarm = useRef<SwarmView | null>(null);
  const paceNow = useRef(1);
  const [means, setMeans] = useState<Means>('processor');
  const series = useMemo(() => new LiveSeries(), []);
  const [parts, setParts] = useState<Parts | null>(null);
  const [rates, setRates] = useState('');
  const [pace, setPace] = useState(1);
  const [scale, setScale] = useState('');
  const running = useValue(store, (s) => s.playing);
  const sketching = useValue(store, (s) => s.mode === 'sketch');
  const panel = useValue(store, (s) => s.panel);
  const weight = 3;

  const run = (on: boolean) => {
    store.set({ playing: on });
    steer(store, { do: on ? 'resume' : 'pause' });
  };
  const setThePace = (value: number) => {
    setPace(value);
    paceNow.current = value;
    steer(store, { do: 'pace', value });
  };
  const hasten = (by: number) => {
    const k = PACES.indexOf(paceNow.current) + by;
    setThePace(PACES[Math.min(Math.max(k, 0), PACES.length - 1)]);
  };
  const sketch = () => store.set({ mode: store.get().mode === 'sketch' ? 'steer' : 'sketch' });
  const step = () => {
    store.set({ playing: false });
    steer(store, { do: 'step' });
  };
  const keys = useMemo((): Key[] => [
    ...new Crosshair().keys(() => (canvas.current ? [canvas.current] : [])),
    { keys: [' '], shown: 'space', text: 'pause or go on', group: 'Time', act: () => run(!store.get().playing) },
    { keys: ['ArrowRight', '.'], shown: '→', text: 'one step', group: 'Time', act: step },
    { keys: ['r'], shown: 'r', text: 'reset to the start', group: 'Time', act: () => steer(store, { do: 'reset' }) },
    { keys: ['e'], shown: 'e', text: 'no attraction any more', group: 'Steer', act: () => steer(store, { do: 'release' }) },
    { keys: ['d'], shown: 'd', text: 'draw a way that leads', group: 'Steer', act: sketch },
    { keys: ['+', '='], shown: '+', text: 'faster', group: 'Time', act: () => hasten(1) },
    { keys: ['-'], shown: '−', text: 'slower', group: 'Time', act: () => hasten(-1) },
    ...moveKeys(() => swarm.current?.space),
    ...VIEWS.map(([view, words], k): Key => ({ keys: [String(k + 1)], shown: String(k + 1),
      text: words, group: 'View', act: () => store.set({ view: view as ViewName }) })),
    { keys: ['g'], shown: 'g', text: 'ground grid', group: 'Show', act: () => store.set({ grid: !store.get().grid }) },
    { keys: ['t'], shown: 't', text: 'trails', group: 'Show', act: () => store.set({ trails: store.get().trails > 0 ? 0 : 20 }) },
    { keys: ['l'], shown: 'l', text: 'light or dark', group: 'Show', act: () => flipTheme(store) },
    { keys: ['m'], shown: 'm', text: 'panel', group: 'Show', act: () => store.set({ panel: !store.get().panel }) },
    { keys: ['?'], shown: '?', text: 'this help', group: 'Show', act: () => store.set({ help: !store.get().help }) },
    { keys: ['Escape'], shown: 'Esc', text: 'close', group: 'Show', act: () => store.set({ help: false, mode: 'steer', message: '' }) },
  ], []);

  useEffect(() => {
    listenToKeys(keys);
    let view: SwarmView | null = null;
    if (canvas.current) {
      view = new SwarmView(canvas.current, session, store, {
        attract: (position) => steer(store, { do: 'attract', position, weight }),
        moveGoal: (index, position) => steer(store, { do: 'goal', index, position }),
        movePredator: (index, position) => steer(store, { do: 'predator', index, position }),
        lead: (points) => {
          store.set({ mode: 'steer' });
          if (session.paths.length === 0) return steer(store, { do: 'lead', points, seconds: 12, weight });
          post('api/steer', { do: 'guide', points })
            .then(() => getJson<SceneSession>('api/session'))
            .then((now) => view?.showPaths(now.paths))
            .catch((error: unknown) => store.fail(error));
        },
      });
      swarm.current = view;
      setScale(`grid ${view.space.gridStep} m`);
      Object.assign(window, { flocklift: { store, swarm: view, series } });
      requestIdleCallback(() => {
        setMeans(askForCard());
        setParts(bringParts());
      }, { timeout: 500 });
    }
    let said = 0;
    watchLive((look) => {
      store.set({ gone: false });
      view?.take(look);
      series.take(look);
      if (performance.now() - said > 400) {
        said = performance.now();
        setRates(`${look.agents} animals · ${look.time.toFixed(1)} s · ${Math.round(look.looksPerSecond)} looks/s · ${Math.round(look.stepsPerSecond)} steps/s`);
      }
    }).then(() => store.set({ gone: true }), () => store.set({ gone: true }));
  }, []);

  return (
    <div class={'page' + (panel ? '' : ' no-panel')}>
      <header class="top">
        <h1>flocklift</h1>
        <span class="name">{session.name}</span>
        <span class="space" />
        <ThemeButton store={store} />
        <button title="panel (m)" onClick={() => store.set({ panel: !panel })}>▤</button>
        <button title="keys (?)" onClick={() => store.set({ help: true })}>?</button>
      </header>
      <main class="single">
        <section class="pane flight">
          <canvas ref={canvas} tabIndex={0} aria-label="the running scene" />
          <div class="overlay">
            <ViewButtons store={store} film={session.camera !== null} />
            <span class="tag">{means === 'no WebGL' ? NO_WEBGL : ''}</span>
            <span class="tag end">{scale}</span>
          </div>
        </section>
      </main>
      {parts ? <parts.LiveCharts series={series} store={store} /> : <div class="charts" />}
      <div class="transport">
        <button class="play" title="pause or go on (space)" aria-label={running ? 'pause' : 'play'}
          onClick={() => run(!running)}>{running ? '❚❚' : '▶'}</button>
        <button title="one step (right)" onClick={step}>›</button>
        <button title="to the start (r)" onClick={() => steer(store, { do: 'reset' })}>reset</button>
        <button title="no attraction any more (e)" onClick={() => steer(store, { do: 'release' })}>release</button>
        <button class={sketching ? 'on' : ''} title="draw a way that leads everybody (d)" onClick={sketch}>draw a way</button>
        <span class="space" />
        <span class="time">{rates}</span>
        <select aria-label="pace" value={pace} onChange={(e) => setThePace(Number(e.currentTarget.value))}>
          {PACES.map((p) => <option value={p}>{p}×</option>)}
        </select>
      </div>
      {panel && <aside>{parts && <parts.SteerPanel session={session} store={store} />}</aside>}
      <Notices store={store} />
      <Help store={store} keys={keys} mouse={MOUSE} />
    </div>
  );
}
