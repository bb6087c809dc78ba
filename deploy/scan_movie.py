#!/usr/bin/python3
"""Reads a recording of the ground for deploy/make-readme-images.sh.

  scan_movie.py cut RECORDING SECONDS OUT.mcap     the recording as it was after so many seconds of scan
  scan_movie.py movie RECORDING FOLDER OUT.gif     feedback in the recording beside FOLDER/SECONDS.png

Needs zstd and python3-pil. The cut has no index, as after a power failure; `isotherm reconstruct` reads it.
"""
import glob
import io
import os
import struct
import subprocess
import sys

FRAME_MS = 160  # Each frame of the movie is shown for this long; the scan advances by STEP_S.
STEP_S = 0.5
SIZE = (912, 388)
MODEL_LEFT = 372
BACKGROUND, TEXT, FAINT = (38, 42, 50), (255, 255, 255), (160, 166, 176)
FONT = "/usr/share/fonts/truetype/dejavu/DejaVuSans%s.ttf"
OPCODE_CHANNEL, OPCODE_MESSAGE, OPCODE_CHUNK, OPCODE_DATA_END = 4, 5, 6, 15


def records(data, begin):
    """Yields (opcode, begin, end) of the MCAP records from `begin` on."""
    while begin + 9 <= len(data):
        size = struct.unpack_from("<Q", data, begin + 1)[0]
        yield data[begin], begin + 9, begin + 9 + size
        begin += 9 + size


def chunks(data):
    """Yields (newest time in ns, end in the file, uncompressed records) of each chunk; the last one is lazy."""
    for opcode, begin, end in records(data, 8):
        if opcode == OPCODE_DATA_END:
            return
        if opcode != OPCODE_CHUNK:
            continue
        newest = struct.unpack_from("<Q", data, begin + 8)[0]
        name_size = struct.unpack_from("<I", data, begin + 28)[0]
        compression = bytes(data[begin + 32:begin + 32 + name_size])
        packed = data[begin + 40 + name_size:end]

        def unpack(packed=packed, compression=compression):
            if compression == b"":
                return packed
            return subprocess.run(["zstd", "-dcq"], input=packed, stdout=subprocess.PIPE, check=True).stdout

        yield newest, end, unpack


def start_of(data):
    """The oldest capture time of the recording, nanoseconds."""
    return min(struct.unpack_from("<Q", data, begin)[0]
               for opcode, begin, _ in records(data, 8) if opcode == OPCODE_CHUNK)


def cut(recording, seconds, out):
    with open(recording, "rb") as file:
        data = file.read()
    limit = start_of(data) + int(float(seconds) * 1e9)
    end = next((begin for begin in _ends_before(data, limit)), len(data))
    with open(out, "wb") as file:
        file.write(data[:end])


def _ends_before(data, limit):
    """Yields the end of the last chunk whose newest message is not after `limit`."""
    last = None
    for newest, end, _ in chunks(data):
        if newest > limit and last is not None:
            yield last
            return
        last = end


def fields(message):
    """A Protobuf message as {field number: [values]}; only what FeedbackRecord uses."""
    result, at = {}, 0

    def varint():
        nonlocal at
        value = shift = 0
        while True:
            byte = message[at]
            at += 1
            value |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                return value

    while at < len(message):
        key = varint()
        kind = key & 7
        if kind == 0:
            value = varint()
        elif kind == 1:
            value = struct.unpack_from("<d", message, at)[0]
            at += 8
        elif kind == 5:
            value = struct.unpack_from("<f", message, at)[0]
            at += 4
        else:
            size = varint()
            value = message[at:at + size]
            at += size
        result.setdefault(key >> 3, []).append(value)
    return result


def feedback_of(recording):
    """Returns [(seconds since the start, fields of FeedbackRecord, PNG or None)] in order of time."""
    with open(recording, "rb") as file:
        data = file.read()
    start = start_of(data)
    topics, words, images = {}, {}, {}
    for _, _, unpack in chunks(data):
        content = unpack()
        for opcode, begin, end in records(content, 0):
            if opcode == OPCODE_CHANNEL:
                number, _, size = struct.unpack_from("<HHI", content, begin)
                topics[number] = content[begin + 8:begin + 8 + size].decode()
            elif opcode == OPCODE_MESSAGE:
                channel, _, time = struct.unpack_from("<HIQ", content, begin)
                if topics.get(channel) == "/feedback":
                    words[time] = fields(content[begin + 22:end])
                elif topics.get(channel) == "/feedback/image":
                    images[time] = fields(content[begin + 22:end])[2][0]
    return [((time - start) / 1e9, words[time], images.get(time)) for time in sorted(words)]


def coverage(message, field):
    """The good ratio of a CoverageRecord in percent."""
    record = fields(message[field][0]) if field in message else {}
    return round(100 * record.get(1, [0.0])[0])


def movie(recording, folder, out):
    from PIL import Image, ImageDraw, ImageFont

    bold = ImageFont.truetype(FONT % "-Bold", 18)
    plain = ImageFont.truetype(FONT % "", 13)
    feedback = feedback_of(recording)
    model_at = sorted((float(os.path.basename(path)[:-4]), path) for path in glob.glob(folder + "/*.png"))

    def draw(seconds):
        message, image = next((m, i) for t, m, i in reversed(feedback) if t <= seconds and i is not None)
        frame = Image.new("RGB", SIZE, BACKGROUND)
        # The operator's side: the confidence image as it was sent, twice as large, and the words.
        view = Image.open(io.BytesIO(image)).convert("RGB")
        frame.paste(view.resize((320, 240), Image.NEAREST), (12, 36))
        canvas = ImageDraw.Draw(frame)
        canvas.text((12, 11), "what the rig is told", TEXT, plain)
        canvas.text((SIZE[0] - 12, 11), "%4.1f s" % seconds, FAINT, plain, anchor="ra")
        advice = message[10][0].decode() if 10 in message else "carry on"
        canvas.text((12, 288), advice, TEXT, bold)
        if 11 in message:
            canvas.text((12, 313), message[11][0].decode(), TEXT, plain)
        canvas.text((12, 337), "%s; measured well: %d %% of the view, %d %% of all" % (
            message[5][0].decode(), coverage(message, 7), coverage(message, 8)), FAINT, plain)
        left = 12
        for colour, word in (((40, 170, 60), "good"), ((215, 190, 40), "acceptable"), ((205, 55, 45), "bad"),
                             ((60, 100, 220), "never measured")):
            canvas.rectangle((left, 365, left + 11, 376), fill=colour)
            canvas.text((left + 16, 362), word, FAINT, plain)
            left += 28 + int(plain.getlength(word))
        canvas.text((MODEL_LEFT, 11), "the model so far: apparent temperature", TEXT, plain)
        path = [path for time, path in model_at if time <= seconds + 1e-6]
        frame.paste(Image.open(path[-1] if path else model_at[0][1]).convert("RGB"), (MODEL_LEFT, 36))
        return frame

    end = max(feedback[-1][0], model_at[-1][0])
    first = next(t for t, _, image in feedback if image is not None)
    times = [first + STEP_S * i for i in range(int((end - first) / STEP_S) + 1)] + [end]
    frames = [draw(seconds) for seconds in times]
    # One palette for all, taken from the last frame with all colours and one in the middle.
    both = Image.new("RGB", (SIZE[0], 2 * SIZE[1]))
    both.paste(frames[-1], (0, 0))
    both.paste(frames[len(frames) // 3], (0, SIZE[1]))
    palette = both.quantize(255, method=Image.MEDIANCUT)
    frames = [frame.quantize(palette=palette, dither=Image.NONE) for frame in frames]
    frames[0].save(out, save_all=True, append_images=frames[1:], loop=0, optimize=False,
                   duration=[FRAME_MS] * (len(frames) - 1) + [2500])
    print("%s: %d frames, %.2f MB" % (out, len(frames), os.path.getsize(out) / 1e6))


if __name__ == "__main__":
    commands = {"cut": cut, "movie": movie}
    if len(sys.argv) != 5 or sys.argv[1] not in commands:
        sys.exit(__doc__)
    commands[sys.argv[1]](*sys.argv[2:])
