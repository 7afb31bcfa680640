// The time that everything on the page shows.
// In: the run's start and end, s. Out: calls to whoever subscribed, each time the time or its passing changes.

/** Playing takes about so long unless the reader chooses another speed, s. */
const PLEASANT = 8;

/** The 1, 2, 5 ladder of speeds about `speed`, four decades. */
export function speeds(speed) {
  const middle = Math.floor(Math.log10(speed));
  const ladder = [];
  for (let power = middle - 2; power <= middle + 2; power += 1) {
    for (const digit of [1, 2, 5]) ladder.push(Number(`${digit}e${power}`));
  }
  return ladder;
}

/** Real time where that is pleasant to look at, else the round speed that plays the run in about eight seconds. */
export function pleasantSpeed(duration) {
  if (duration >= 2 && duration <= 20) return 1;
  const wanted = duration / PLEASANT;
  const near = speeds(wanted);
  return near.reduce((a, b) => (Math.abs(Math.log(b / wanted)) < Math.abs(Math.log(a / wanted)) ? b : a));
}

export class Clock {
  #listeners = [];
  #last = null;

  constructor(start, end) {
    this.start = start;
    this.end = Math.max(end, start);
    this.time = start;
    this.playing = false;
    this.loops = true;
    this.speed = pleasantSpeed(this.end - this.start || 1);
  }

  /** Calls `listener` now and after each change. */
  subscribe(listener) {
    this.#listeners.push(listener);
    listener(this);
  }

  /** Another run, from `start` to `end`, s: the time stays where it is, or is at its nearer end. */
  span(start, end) {
    this.start = start;
    this.end = Math.max(end, start);
    this.seek(this.time);
  }

  /** Goes to `time`, s; what is outside the run is its nearer end. */
  seek(time) {
    this.time = Math.min(Math.max(time, this.start), this.end);
    this.#tell();
  }

  play() {
    if (this.playing) return;
    if (this.time >= this.end) this.time = this.start;
    this.playing = true;
    this.#last = null;
    requestAnimationFrame((now) => this.#advance(now));
    this.#tell();
  }

  pause() {
    this.playing = false;
    this.#tell();
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  #advance(now) {
    if (!this.playing) return;
    // A tab that was in the background goes on from where it was.
    const passed = this.#last === null ? 0 : Math.min(now - this.#last, 100) / 1000;
    this.#last = now;
    let time = this.time + passed * this.speed;
    if (time >= this.end) {
      const duration = this.end - this.start;
      if (this.loops && duration > 0) time = this.start + ((time - this.start) % duration);
      else {
        time = this.end;
        this.playing = false;
      }
    }
    this.seek(time);
    if (this.playing) requestAnimationFrame((next) => this.#advance(next));
  }

  #tell() {
    for (const listener of this.#listeners) listener(this);
  }
}

/** The index of the last of the ascending `times` that is not after `time`; 0 before the first. */
export function sampleAt(times, time) {
  let low = 0;
  let high = times.length - 1;
  while (low < high) {
    const middle = (low + high + 1) >> 1;
    if (times[middle] <= time) low = middle;
    else high = middle - 1;
  }
  return low;
}

/** That index, and how far `time` is on the way to the next sample, 0 to 1. */
export function between(times, time) {
  const index = sampleAt(times, time);
  const next = Math.min(index + 1, times.length - 1);
  const step = times[next] - times[index];
  return { index, next, part: step > 0 ? Math.min(Math.max((time - times[index]) / step, 0), 1) : 0 };
}
