// Recordings as cards and oscilloscopes write them.

/** A shot as a card at 1 MHz records it: 10 mV/N, 400 µs before the impact, some noise. */
export async function recorded(page) {
  const { interval, signals } = await page.evaluate(async () => {
    const { ask, decoded } = hertzchain;
    const [{ text }] = await ask("test", { verb: "presets" });
    const { motion } = await ask("test", { verb: "shot", text, samples: 3000 });
    return { interval: motion.interval_s, signals: [motion.sensor_n, motion.wall_n].map((one) => [...decoded(one)]) };
  });
  const interval_s = 1e-6;
  const volts = (signal, sample) => {
    const time_s = sample * interval_s - 400e-6;
    const noise = 0.002 * Math.sin(37.7 * sample) * Math.cos(11.3 * sample);
    return noise + (time_s < 0 ? 0 : 0.01 * signal[Math.min(signal.length - 1, Math.round(time_s / interval))]);
  };
  return { interval_s, channels: signals.map((signal) => Array.from({ length: 3000 }, (_, sample) => volts(signal, sample))) };
}

/** A TDMS file of one segment: channels of doubles with their sampling interval. */
export function tdms(interval_s, channels) {
  const u32 = (value) => Buffer.from(Uint32Array.of(value).buffer);
  const u64 = (value) => Buffer.from(BigUint64Array.of(BigInt(value)).buffer);
  const doubles = (values) => Buffer.from(Float64Array.from(values).buffer);
  const text = (words) => Buffer.concat([u32(Buffer.byteLength(words)), Buffer.from(words)]);
  const [DOUBLE, NONE] = [10, 0xffffffff];
  const objects = channels.map((channel, at) => Buffer.concat([
    text(`/'shots'/'channel ${at + 1}'`), u32(20), u32(DOUBLE), u32(1), u64(channel.length),
    u32(1), text("wf_increment"), u32(DOUBLE), doubles([interval_s]),
  ]));
  const above = ["/", "/'shots'"].map((path) => Buffer.concat([text(path), u32(NONE), u32(0)]));
  const about = Buffer.concat([u32(2 + channels.length), ...above, ...objects]);
  const data = Buffer.concat(channels.map(doubles));
  const contents = 0b1110;
  return Buffer.concat([Buffer.from("TDSm"), u32(contents), u32(4713), u64(about.length + data.length), u64(about.length), about, data]);
}
