// SPDX-FileCopyrightText: 2026 the flocklift authors
// SPDX-License-Identifier: BSD-3-Clause
//
// The page of a run: footage and flock side by side, curves and the play bar under them, and a
// panel for looking, solving, mending or sketching.

import { useLayoutEffect, useMemo, useRef, useState } from 'preact/hooks';

import { Crosshair } from './crosshair';
import { FlightView } from './flight';
import { FootageView } from './footage';
import { Help } from './help';
import { listenToKeys, type Key } from './keys';
import { Mending, type Tool } from './mending';
import { Notices } from './notices';
import { bringParts } from './parts';
import type { Parts } from './later';
import type { Run } from './run';
import { NO_WEBGL, askForCard, type Means } from './graphics';
import { useValue, type Mode, type ViewName } from './state';
import { ThemeButton, flipTheme } from './theme';
import { SPEEDS, Transport } from './transport';
import { VIEWS, ViewButtons, moveKeys } from './viewButtons';

const MODES: [Mode, string][] = [
  ['look', 'Look'],
  ['solve', 'Re-solve'],
  ['mend', 'Mend'],
  ['sketch', 'Sketch'],
];

const MOUSE: [string, string][] = [
  ['click', 'select an animal, in either picture'],
  ['shift-click', 'select the second one'],
  ['wheel', 'zoom at the pointer'],
  ['drag', 'move the zoomed footage; turn the flock (right button: move it)'],
  ['double click', 'the whole footage again'],
];

// The page's pictures, once they are there.
interface Views {
  footage: FootageView | null;
  flight: FlightView | null;
}

function keysOf(run: Run, mending: Mending, crosshair: Crosshair, views: Views): Key[] {
  const { store, clock } = run;
  const flip = (name: 'boxes' | 'ids' | 'bars' | 'grid' | 'solo' | 'loop' | 'panel' | 'help') => () =>
    store.set({ [name]: !store.get()[name] });
  const pace = (by: number) => () => {
    const k = SPEEDS.indexOf(store.get().speed) + by;
    store.set({ speed: SPEEDS[Math.min(Math.max(k, 0), SPEEDS.length - 1)] });
  };
  const next = (by: number) => () => {
    const n = run.animals.length;
    if (n > 0) store.set({ selected: (store.get().selected + by + n) % n });
  };
  const second = () => store.set({ second: store.get().selected });
  const hide = () => {
    const { selected, hidden } = store.get();
    if (selected >= 0) store.set({ hidden: new Set([...hidden, selected]), selected: -1 });
  };
  const looks = VIEWS.map(([view, words], k): Key => ({ keys: [String(k + 1)], shown: String(k + 1),
    text: words, group: 'View', act: () => store.set({ view: view as ViewName }) }));
  const pictures = () => [views.footage?.canvas, views.flight?.space.canvas].filter((c) => c !== undefined);
  const point = (tool: Tool) => () => {
    mending.choose(tool);
    const { footage } = views;
    if (mending.tool === 'none' || !footage) crosshair.hide();
    else crosshair.show(footage.canvas, footage.onScreen(store.get().selected));
  };
  const keys: Key[] = [
    ...crosshair.keys(pictures, () => mending.drop()),
    { keys: [' '], shown: 'space', text: 'play or pause', group: 'Time', act: () => store.set({ playing: !store.get().playing }) },
    { keys: ['ArrowRight', '.'], shown: '→', text: 'one frame on', group: 'Time', act: () => clock.step(1) },
    { keys: ['ArrowLeft', ','], shown: '←', text: 'one frame back', group: 'Time', act: () => clock.step(-1) },
    { keys: ['Shift+ArrowRight'], shown: 'shift →', text: 'ten frames on', group: 'Time', act: () => clock.step(10) },
    { keys: ['Shift+ArrowLeft'], shown: 'shift ←', text: 'ten frames back', group: 'Time', act: () => clock.step(-10) },
    { keys: ['Home'], shown: 'Home', text: 'first frame', group: 'Time', act: () => clock.go(clock.first) },
    { keys: ['End'], shown: 'End', text: 'last frame', group: 'Time', act: () => clock.go(clock.end) },
    { keys: ['o'], shown: 'o', text: 'over and over', group: 'Time', act: flip('loop') },
    { keys: ['+', '='], shown: '+', text: 'faster', group: 'Time', act: pace(1) },
    { keys: ['-'], shown: '−', text: 'slower', group: 'Time', act: pace(-1) },
    ...looks,
    ...moveKeys(() => views.flight?.space),
    { keys: ['f'], shown: 'f', text: 'the flock into sight', group: 'View', act: () => views.flight?.fit() },
    { keys: ['b'], shown: 'b', text: 'boxes', group: 'Show', act: flip('boxes') },
    { keys: ['i'], shown: 'i', text: 'ids', group: 'Show', act: flip('ids') },
    { keys: ['u'], shown: 'u', text: 'depth uncertainty', group: 'Show', act: flip('bars') },
    { keys: ['g'], shown: 'g', text: 'ground grid', group: 'Show', act: flip('grid') },
    { keys: ['t'], shown: 't', text: 'trails', group: 'Show', act: () => store.set({ trails: store.get().trails > 0 ? 0 : 30 }) },
    { keys: ['l'], shown: 'l', text: 'light or dark', group: 'Show', act: () => flipTheme(store) },
    { keys: ['m'], shown: 'm', text: 'panel', group: 'Show', act: flip('panel') },
    { keys: ['?'], shown: '?', text: 'this help', group: 'Show', act: flip('help') },
    { keys: ['Tab'], shown: 'Tab', text: 'next animal', group: 'Animals', act: next(1) },
    { keys: ['Shift+Tab'], shown: 'shift Tab', text: 'animal before', group: 'Animals', act: next(-1) },
    { keys: ['w'], shown: 'w', text: 'keep it as the second one', group: 'Animals', act: second },
    { keys: ['s'], shown: 's', text: 'solo: only the selected', group: 'Animals', act: flip('solo') },
    { keys: ['h'], shown: 'h', text: 'hide the selected', group: 'Animals', act: hide },
    { keys: ['Shift+H'], shown: 'shift h', text: 'show all', group: 'Animals', act: () => store.set({ hidden: new Set() }) },
    { keys: ['Escape'], shown: 'Esc', text: 'select none, close', group: 'Animals', act: () => {
      (document.activeElement as HTMLElement | null)?.blur();
      store.set({ selected: -1, second: -1, solo: false, help: false, message: '' });
    } },
  ];
  if (run.session.exported) return keys;
  const mode = (m: Mode) => () => {
    store.set({ mode: m, panel: true });
    document.querySelector<HTMLElement>('aside')?.focus(); // Tab goes on from there
  };
  const mend = (group: string, key: string, text: string, act: () => void, shown = key): Key => ({
    keys: [key], shown, text, group, act });
  return [
    ...keys,
    mend('Panels', 'F1', 'look', mode('look')),
    mend('Panels', 'F2', 're-solve', mode('solve')),
    mend('Panels', 'F3', 'mend', mode('mend')),
    mend('Panels', 'F4', 'sketch', mode('sketch')),
    mend('Panels', 'Shift+B', 'flock before or after', () => {
      if (run.versions.after > 0) store.set({ table: store.get().table === 'after' ? 'before' : 'after' });
    }, 'shift b'),
    mend('Mend', 'x', 'swap the two from here on', () => void mending.swap()),
    mend('Mend', 'c', 'split here', () => void mending.split()),
    mend('Mend', 'j', 'join the two', () => void mending.join()),
    mend('Mend', 'Delete', 'delete the track', () => void mending.remove(), 'Del'),
    mend('Mend', 'p', 'pin: then the place, by click or crosshair', point('pin')),
    mend('Mend', 'a', 'add: likewise', point('add')),
    { keys: ['z', 'Ctrl+z'], shown: 'z', text: 'undo', group: 'Mend', act: () => void mending.undo() },
    { keys: ['y', 'Ctrl+y', 'Ctrl+Shift+z'], shown: 'y', text: 'redo', group: 'Mend', act: () => void mending.redo() },
    mend('Mend', 'n', 'next place of doubt', () => mending.jump(1)),
    mend('Mend', 'Shift+N', 'place of doubt before', () => mending.jump(-1), 'shift n'),
  ];
}

export function RunPage({ run }: { run: Run }) {
  const { store, session } = run;
  const views = useMemo((): Views => ({ footage: null, flight: null }), []);
  const crosshair = useMemo(() => new Crosshair(), []);
  const film = useRef<HTMLCanvasElement>(null);
  const space = useRef<HTMLCanvasElement>(null);
  const [footage, setFootage] = useState<FootageView | null>(null);
  const [scale, setScale] = useState('');
  const mending = useMemo(() => new Mending(run), [run]);
  const keys = useMemo(() => keysOf(run, mending, crosshair, views), [run]);
  const mode = useValue(store, (s) => s.mode);
  const panel = useValue(store, (s) => s.panel);
  const table = useValue(store, (s) => s.table);
  const reading = useValue(store, (s) => s.reading);
  const [means, setMeans] = useState<Means>('processor');
  const [parts, setParts] = useState<Parts | null>(null);
  const hasFlock = session.has.before || run.versions.after > 0;

  // At once: by useEffect() it would be after a picture of the empty page.
  useLayoutEffect(() => {
    listenToKeys(keys);
    const handle: Record<string, unknown> = { run }; // for tests
    if (film.current) {
      const view = new FootageView(film.current, run);
      view.onPoint = (x, y, animal, second) => {
        if (mending.click(x, y)) return crosshair.hide();
        store.set(second ? { second: animal } : { selected: animal, second: -1 });
      };
      setFootage(view);
      handle.footage = views.footage = view;
    }
    if (space.current) {
      const view = new FlightView(space.current, run);
      setScale(`grid ${view.space.gridStep} m`);
      view.onGrid = (step) => setScale(`grid ${step} m`);
      handle.flight = views.flight = view;
    }
    Object.assign(window, { flocklift: handle });
    void run.clock.drawn.then(() => {
      requestIdleCallback(() => {
        setMeans(askForCard());
        setParts(bringParts());
      }, { timeout: 500 });
      if (session.exported || !session.has.boxes) return;
      run.askSuspects().catch((error: unknown) => store.fail(error));
    });
  }, []);

  const nothing = !session.has.boxes && !hasFlock && !session.footage;
  return (
    <div class={'page' + (panel ? '' : ' no-panel')}>
      <header class="top">
        <h1>flocklift</h1>
        <span class="name">{session.name}</span>
        {!session.exported && (
          <nav>{MODES.map(([m, words]) => (
            <button class={mode === m && panel ? 'on' : ''}
              onClick={() => store.set({ mode: m, panel: true })}>{words}</button>))}
          </nav>
        )}
        <span class="space" />
        {reading && <span class="reading" role="status">{reading}</span>}
        <ThemeButton store={store} />
        <button title="panel (m)" onClick={() => store.set({ panel: !panel })}>▤</button>
        <button title="keys (?)" onClick={() => store.set({ help: true })}>?</button>
      </header>
      <main>
        <section class="pane film">
          <canvas ref={film} tabIndex={0} aria-label="footage with tracks" />
          {!session.footage && <p class="words">{session.noFootage || 'There is no footage.'} {session.has.boxes ? 'The tracks are drawn without it.' : ''}</p>}
        </section>
        <section class="pane flight">
          <canvas ref={space} tabIndex={0} aria-label="the flock in space" />
          {hasFlock && (
            <div class="overlay">
              <ViewButtons store={store} film={session.camera !== null} />
              <span class="tag">{[table === 'after' ? 'solved here' : '', means === 'no WebGL' ? NO_WEBGL : '']
                .filter(Boolean).join(' · ')}</span>
              <span class="tag end">{scale}</span>
            </div>
          )}
          {!hasFlock && <p class="words">{nothing ? 'There is nothing to show yet.' : 'The folder holds no trajectories yet: run `flocklift reconstruct`, or Re-solve here.'}</p>}
        </section>
      </main>
      {parts ? <parts.Charts run={run} /> : <div class="charts" />}
      <Transport run={run} />
      {panel && (
        <aside tabIndex={-1}>
          {parts && (mode === 'look' || session.exported) && <parts.LookPanel run={run} />}
          {parts && mode === 'solve' && !session.exported && <parts.SolvePanel run={run} />}
          {parts && mode === 'mend' && !session.exported && <parts.MendPanel run={run} mending={mending} />}
          {parts && mode === 'sketch' && !session.exported && footage && <parts.SketchPanel run={run} footage={footage} fit={() => views.flight?.fit()} />}
        </aside>
      )}
      <Notices store={store} />
      <Help store={store} keys={keys} mouse={MOUSE} />
    </div>
  );
}
