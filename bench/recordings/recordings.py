"""Forty recordings in the layouts of instruments, and what `hertzchain measure` makes of each.

usage: python recordings.py PROGRAM FOLDER      (needs numpy, scipy and h5py: requirements.txt)

Each recording has a shot of three bells, 761.9 and 797.9 µs apart, in noise of 40 dB at 1 MS/s. It
is measured without options; if the program refuses it, again with the one option given here. Prints
a table in Markdown; exit code 1 if a recording is not read, or a time is off by more than 1 µs.
"""

import json
import pathlib
import struct
import subprocess
import sys
import wave

import h5py
import numpy as np
import scipy.io

RATE = 1e6
INCIDENT, REFLECTED = 761.9e-6, 797.9e-6
random = np.random.default_rng(5)


def pulses(heights=(1.0, 1.6, 0.35), count=3000, lead=600e-6):
    """The summed signal in V and the sensors' own, without noise."""
    times = np.arange(count) / RATE
    places = np.cumsum([lead, INCIDENT, REFLECTED])
    bells = []
    for place, height in zip(places, heights):
        turn = 2 * np.arccos(0.5 ** (1 / 6)) * (times - place) / 45e-6
        bells.append(height * np.where(abs(turn) < np.pi / 2, np.cos(turn) ** 6, 0.0))
    return sum(bells), bells[0] + bells[2], bells[1]


def noise(samples, deviation=0.01):
    return samples + random.normal(0, deviation, len(samples))


def summed():
    return noise(pulses()[0])


def both():
    _, sensor, wall = pulses()
    return noise(sensor), noise(wall)


TIMES = (np.arange(3000) - 500) / RATE
SHOTS = [summed() for _ in range(3)]
RECORDINGS = {}


def recording(name, option=()):
    """Registers the writer of a recording, and the option that its refusal may name."""

    def register(write):
        RECORDINGS[name] = (write, list(option))
        return write

    return register


def rows(head, times, columns, line="{:.6e},{:.5f}", end="\n"):
    body = (line.format(*row) for row in zip(times, *columns))
    return head + end.join(body) + end


# Oscilloscopes, as text


@recording("tektronix.csv")
def _(path):
    head = (
        'Model,MSO24\nFirmware Version,1.40\nWaveform Type,ANALOG\nPoint Format,Y\nHorizontal Units,s\n'
        'Horizontal Scale,0.0004\nSample Interval,1e-06\nRecord Length,3000\nVertical Units,V\n\nTIME,CH1\n'
    )
    path.write_text(rows(head, TIMES, [summed()]))


@recording("tektronix-beside.csv")
def _(path):
    facts = ['"Record Length",3000,"Points",', '"Sample Interval",1e-06,s,', '"Trigger Point",500,"Samples",']
    lines = []
    for i, (time, volt) in enumerate(zip(TIMES, summed())):
        lines.append((facts[i] if i < len(facts) else ",,,") + f"{time:.6f},{volt:.5f}")
    path.write_text("\n".join(lines) + "\n")


@recording("keysight.csv")
def _(path):
    path.write_text(rows("x-axis,1\nsecond,Volt\n", TIMES, [summed()]))


@recording("rigol.csv")
def _(path):
    head = "X,CH1,Start,Increment,\nSequence,Volt,-5.000000e-04,1.000000e-06,\n"
    lines = (f"{i},{volt:.5f},," for i, volt in enumerate(summed()))
    path.write_text(head + "\n".join(lines) + "\n")


@recording("lecroy.csv")
def _(path):
    head = "LECROYWR204Xi,12345,Waveform\nSegments,1,SegmentSize,3000\nSegment,TrigTime,TimeSinceSegment1\n"
    head += "#1,25-Nov-2026 10:00:00,0\nTime,Ampl\n"
    path.write_text(rows(head, TIMES, [summed()], "{:.7g},{:.5f}"))


@recording("siglent.csv")
def _(path):
    head = "Record Length,Analog:3000\nSample Interval,CH1:0.000001000\nVertical Units,CH1:V\n"
    head += "Model Number,SDS1204X-E\nSource,CH1\nSecond,Value\n"
    path.write_text(rows(head, TIMES, [summed()], "{:.8f},{:.5f}"))


@recording("yokogawa.csv")
def _(path):
    head = '"Header Size",6\n"Model Name","DLM"\n"TraceName","CH1"\n"HResolution",1.0E-06\n"HUnit","s"\n"VUnit","V"\n'
    path.write_text(head + "".join(f",{volt:.5E}\n" for volt in summed()))


@recording("picoscope.csv")
def _(path):
    path.write_text(rows("Time,Channel A\n(ms),(V)\n\n", 1e3 * TIMES, [summed()], "{:.8f},{:.5f}"))


@recording("picoscope-german.csv")
def _(path):
    text = rows("Zeit;Kanal A\n(us);(V)\n\n", 1e6 * TIMES, [summed()], "{:.3f};{:.5f}")
    path.write_text(text.replace(".", ","))


@recording("hantek.txt")
def _(path):
    head = "#CLOCK=1.000MHz\n#SIZE=3000\n#UNITS:V\n"
    path.write_text(head + "".join(f"{volt:.5f}\n" for volt in summed()))


# Loggers and programs, as text


@recording("labview-times.lvm")
def _(path):
    path.write_text(lvm("One", "{:.6f}\t{:.6f}\n"))


@recording("labview.lvm")
def _(path):
    path.write_text(lvm("No", "\t{1:.6f}\n"))


@recording("labview-comma.lvm")
def _(path):
    path.write_text(lvm("No", "\t{1:.6f}\n").replace(".", ",").replace("Separator\t.", "Separator\t,"))


def lvm(columns, line):
    head = f"LabVIEW Measurement\t\nWriter_Version\t2\nReader_Version\t2\nSeparator\tTab\nDecimal_Separator\t.\n"
    head += f"Multi_Headings\tNo\nX_Columns\t{columns}\nTime_Pref\tRelative\nOperator\tlab\nDate\t2026/11/25\n"
    head += "Time\t10:00:00.000000\n***End_of_Header***\t\n\t\nChannels\t1\t\nSamples\t3000\t\n"
    head += "Date\t2026/11/25\t\nTime\t10:00:00.000000\t\nY_Unit_Label\tVolts\t\nX_Dimension\tTime\t\nX0\t0.0\t\n"
    head += "Delta_X\t1.000000E-6\t\n***End_of_Header***\t\t\nX_Value\tVoltage\tComment\n"
    return head + "".join(line.format(t, v) for t, v in zip(TIMES, summed()))


@recording("dropped-zeros.csv")
def _(path):
    line = lambda time, volt: f"{np.format_float_positional(time, trim='-')},{volt:.5f}"
    path.write_text("Time (s),Ch1 (V)\n" + "\n".join(map(line, np.round(TIMES - 0.0015, 6), summed())) + "\n")


@recording("spaces.txt")
def _(path):
    path.write_text(rows("% t v\n", TIMES, [summed()], "{:.6e}   {:9.5f}"))


@recording("utf16.txt")
def _(path):
    path.write_text(rows("Time [s]\tForce [V]\n", TIMES, [summed()], "{:.6f}\t{:.5f}"), encoding="utf-16")


@recording("clock.csv")
def _(path):
    stamps = (f"2026-11-25 10:00:00.{i:06d},{volt:.5f}" for i, volt in enumerate(summed()))
    path.write_text("timestamp,volts\n" + "\n".join(stamps) + "\n")


@recording("two-channels.csv")
def _(path):
    path.write_text(rows("Time,Bead 7,Wall\ns,V,V\n", TIMES, both(), "{:.6f},{:.5f},{:.5f}"))


@recording("four-channels.csv", ["--channel", "CH2"])
def _(path):
    columns = [summed() if i == 1 else noise(np.zeros(3000)) for i in range(4)]
    path.write_text(rows("Time,CH1,CH2,CH3,CH4\n", TIMES, columns, "{:.6f},{:.5f},{:.5f},{:.5f},{:.5f}"))


@recording("samples.csv", ["--rate", "1MHz"])
def _(path):
    path.write_text("".join(f"{volt:.5f}\n" for volt in summed()))


@recording("ticks.csv", ["--rate", "1MHz"])
def _(path):
    path.write_text(rows("ticks,V\n", np.arange(3000), [summed()], "{:d},{:.5f}"))


@recording("overload.csv")
def _(path):
    line = lambda time, volt: f"{time:.6f}," + ("Overload" if volt > 1.595 else f"{volt:.5f}")
    path.write_text("Time,Ch1\n(s),(V)\n" + "\n".join(map(line, TIMES, summed())) + "\n")


# Numbers as bytes


@recording("summed.npy", ["--rate", "1MHz"])
def _(path):
    np.save(path, np.array(SHOTS))


@recording("named.npz")
def _(path):
    np.savez_compressed(path, samples=np.array(SHOTS), sampling_rate=RATE, speed=[0.5, 0.5, 0.5])


@recording("counts.wav")
def _(path):
    with wave.open(str(path), "wb") as out:
        out.setparams((1, 2, int(RATE), 0, "NONE", ""))
        out.writeframes((16000 * summed()).astype("<i2").tobytes())


@recording("float.wav")
def _(path):
    scipy.io.wavfile.write(path, int(RATE), summed().astype("f4"))


@recording("labview.tdms")
def _(path):
    text = lambda of: struct.pack("<I", len(of)) + of.encode()
    number = lambda name, value: text(name) + struct.pack("<Id", 10, value)
    objects = text("/") + struct.pack("<II", 0xFFFFFFFF, 0)
    objects += text("/'shot'/'sum'") + struct.pack("<IIIQ", 20, 10, 1, 3000)
    objects += struct.pack("<I", 1) + number("wf_increment", 1 / RATE)
    metadata = struct.pack("<I", 2) + objects
    raw = summed().astype("<f8").tobytes()
    lead = b"TDSm" + struct.pack("<IIQQ", 0xE, 4713, len(metadata) + len(raw), len(metadata))
    path.write_bytes(lead + metadata + raw)


@recording("root.h5")
def _(path):
    with h5py.File(path, "w") as out:
        out["samples"] = np.array(SHOTS, "f4")
        out.attrs["sample_rate"] = RATE


@recording("attribute.h5")
def _(path):
    with h5py.File(path, "w") as out:
        group = out.create_group("daq")
        group["voltage"] = summed()
        group.attrs["sample_rate"] = RATE


@recording("groups.h5")
def _(path):
    with h5py.File(path, "w") as out:
        for number, shot in enumerate(SHOTS):
            group = out.create_group(f"shot_{number:03d}")
            group["voltage"] = shot
            group.attrs["sample_rate"] = int(RATE)
            group.attrs["speed_m_s"] = 0.5


@recording("groups-two-channels.h5")
def _(path):
    with h5py.File(path, "w") as out:
        for number in range(2):
            sensor, wall = both()
            group = out.create_group(f"run {number + 1}")
            group["bead"], group["wall"], group["fs"] = sensor, wall, RATE


@recording("user-block.h5")
def _(path):
    with h5py.File(path, "w", userblock_size=512) as out:
        out["samples"], out["dt"] = np.array(SHOTS), 1 / RATE


@recording("matlab-5.mat")
def _(path):
    scipy.io.savemat(path, {"signal": summed(), "fs": RATE, "note": "steel balls"})


@recording("matlab-5-compressed.mat")
def _(path):
    columns = np.array(both()).T
    scipy.io.savemat(path, {"bead": columns[:, :1], "wall": columns[:, 1:], "dt": 1 / RATE}, do_compression=True)


@recording("picoscope.mat")
def _(path):
    one = lambda value: np.array([[value]])
    parts = {"Tstart": one(-5e-4), "Tinterval": one(1 / RATE), "ExtraSamples": one(0.0)}
    parts |= {"RequestedLength": one(3000.0), "Length": one(3000.0), "Version": one(1.0)}
    scipy.io.savemat(path, parts | {"A": summed().astype("f4").reshape(-1, 1)})


@recording("picoscope-4.mat")
def _(path):
    parts = {"Tstart": -5e-4, "Tinterval": 1 / RATE, "Length": 3000.0}
    scipy.io.savemat(path, parts | {"A": summed().reshape(-1, 1)}, format="4")


@recording("matlab-7.3.mat")
def _(path):
    with h5py.File(path, "w", userblock_size=512, libver="earliest") as out:
        for name, value in [("signal", summed().reshape(1, -1)), ("fs", np.array([[RATE]]))]:
            out.create_dataset(name, data=value).attrs["MATLAB_class"] = np.bytes_("double")
        text = np.array([[ord(letter)] for letter in "steel"], "u2")
        out.create_dataset("note", data=text).attrs["MATLAB_class"] = np.bytes_("char")
    with open(path, "r+b") as out:
        out.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116) + bytes(8) + b"\x00\x02IM")


@recording("matlab-7.3-columns.mat")
def _(path):
    # MATLAB's columns are HDF5's rows.
    with h5py.File(path, "w", userblock_size=512) as out:
        out.create_dataset("data", data=np.array(both()), compression="gzip")
        out.create_dataset("Fs", data=np.array([[RATE]]))
    with open(path, "r+b") as out:
        out.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(116) + bytes(8) + b"\x00\x02IM")


# Signals that are harder than their layout


@recording("hum.csv")
def _(path):
    hum = 0.05 * np.sin(2 * np.pi * 50 * TIMES + 1)
    path.write_text(rows("Time (s),V\n", TIMES, [summed() + hum + 30 * TIMES], "{:.6f},{:.5f}"))


@recording("sensitive-wall.csv")
def _(path):
    strong = noise(pulses((1.0, 4.2, 0.35))[0])
    path.write_text(rows("Time (s),V\n", TIMES, [strong], "{:.6f},{:.5f}"))


def measured(program, path, options):
    """Shots as the program reports them, and its messages."""
    run = subprocess.run([program, "measure", path, "--json", *options], capture_output=True, text=True)
    try:
        shots = json.loads(run.stdout)["shots"]
    except (json.JSONDecodeError, KeyError):
        shots = []
    return shots, run.stderr.strip()


def verdict(shots):
    """Largest error in µs of either time; None where a time is missing."""
    off = []
    for shot in shots:
        for name, true in [("tof_incident_s", INCIDENT), ("tof_reflected_s", REFLECTED)]:
            time = shot.get(name)
            if not time:
                return None
            off.append(abs(time["value"] - true))
    return 1e6 * max(off) if off else None


def main():
    program, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    print("| recording | option | shots | largest error, µs |\n|---|---|---|---|")
    failed = 0
    for name, (write, option) in RECORDINGS.items():
        path = folder / name
        write(path)
        shots, messages = measured(program, path, [])
        used = ""
        off = verdict(shots)
        if off is None and option:
            named = option[0] in messages
            shots, messages = measured(program, path, option)
            off, used = verdict(shots), " ".join(option) + ("" if named else " (not named)")
            failed += not named
        wrong = off is None or off > 1.0
        failed += wrong
        print(f"| {name} | {used} | {len(shots)} | {'—' if off is None else f'{off:.2f}'} |")
        if wrong:
            print(messages[:600], file=sys.stderr)
    print(f"{len(RECORDINGS)} recordings, {failed} not read as they should be", file=sys.stderr)
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
