package waferhand;

import java.nio.ByteBuffer;
import java.nio.charset.StandardCharsets;
import java.util.ArrayList;
import java.util.List;
import java.util.Locale;

/** The marks on the time axis of a run: the events and plungers from state messages, and the commands from motion
 * control's messages. Both are decoded by hand, because the generated classes trust any count and any length.
 */
final class ProximityMarks {
    /** The most of each kind; a run of many hours has fewer. After it the oldest are forgotten. */
    static final int MOST = 1 << 15;

    /** In the order of event.lcm. */
    private static final String[] KINDS = {"picked",      "released",      "handed over",   "near miss",
                                           "contested",   "bad input",     "no support",    "slot occupied",
                                           "off centre",  "askew",         "settled",       "hit",
                                           "undecided",   "too close",     "slipped",       "vacuum lost",
                                           "fault armed", "fault cleared", "pushed through"};
    private static final int HANDED_OVER = 2, NEAR_MISS = 3, CONTESTED = 4;
    /** A bit for each kind that is normal. */
    private static final int WELCOME = 1 | 1 << 1 | 1 << HANDED_OVER | 1 << 10 | 1 << 17;

    /** Something that happened in a slice. */
    static final class Event {
        long utime;
        int kind, wafer, gripper, other;
        double value, limit, z, xy, planar;

        boolean isWelcome() {
            return kind >= 0 && kind < KINDS.length && (WELCOME >> kind & 1) != 0;
        }

        /** Whether it is marked with this gripper's values. Events of no gripper are marked everywhere. */
        boolean concerns(int which) {
            final boolean isOther = (kind == HANDED_OVER || kind == CONTESTED) && other == which;
            return gripper < 0 || gripper == which || isOther;
        }

        String name() {
            return kind >= 0 && kind < KINDS.length ? KINDS[kind] : "event of kind " + kind;
        }

        /** The values that explain it, in words. */
        String values() {
            if (kind <= CONTESTED) {
                return String.format(Locale.ROOT, "|z| %.3f mm, |xy| %.2f mm, n1·n2 %.6f", Math.abs(z), xy,
                                     planar);
            }
            return limit > 0 ? String.format(Locale.ROOT, "%.4g, limit %.4g", value, limit)
            : value != 0     ? String.format(Locale.ROOT, "%.4g", value)
                             : "";
        }
    }

    /** A line that motion control executes. */
    static final class Command {
        static final int GOES_ON = 2, DONE = 3, FAILED = 4;
        long run, begin, end;
        int phase, task, line, error;
        String text, result;

        boolean isOver() {
            return phase >= DONE;
        }

        private Command copy(double until) {
            final Command other = new Command();
            other.run = run;
            other.begin = begin;
            other.end = (long)Math.max(begin, until);
            other.phase = phase;
            other.task = task;
            other.line = line;
            other.error = error;
            other.text = text;
            other.result = result;
            return other;
        }
    }

    /** The events of one state message. */
    static final class State {
        private static final int HEAD = 117, WAFER = 101, GRIPPER = 515, EVENT = 157, FAULT = 328, SAMPLE = 4,
                                 LOST = 1, DOOR = 8, LATCHING = 41, LATCH = 24, CHECK = 8;
        /** The bytes of a gripper before its plunger's phase. */
        private static final int PLUNGER = 270;
        private static final int WAFERS = 256, GRIPPERS = 16, EVENTS = 128, FAULTS = 16, SAMPLES = 64,
                                 DOORS = 8, LATCHES = 16;

        final long utime, seq, run, layout;
        final List<Event> events = new ArrayList<>();
        final List<ProximityPlungers.Plunger> plungers = new ArrayList<>();

        /** Throws an IllegalArgumentException or a BufferUnderflowException when the bytes are not a whole state. */
        State(ByteBuffer data) {
            final int size = data.remaining();
            demand(data.getLong() == state.LCM_FINGERPRINT, "a state");
            utime = data.getLong();
            seq = data.getLong();
            run = data.getLong();
            layout = data.getLong();
            final int status = data.getInt();
            final int wafers = count(data, WAFERS);
            final int grippers = count(data, GRIPPERS);
            final int count = count(data, EVENTS);
            final int faults = count(data, FAULTS);
            final int samples = count(data, SAMPLES);
            final int first = HEAD + WAFER * wafers + GRIPPER * grippers;
            final int lost = first + EVENT * count + FAULT * faults + SAMPLE * samples;
            demand(size >= lost + LOST + 4 + LATCHING + CHECK, "a whole state");
            data.position(lost + LOST);
            final int latching = lost + LOST + 4 + DOOR * count(data, DOORS);
            demand(size >= latching + LATCHING + CHECK, "a whole state");
            data.position(latching);
            final int latches = count(data, LATCHES) + count(data, LATCHES);
            demand(size == latching + LATCHING + LATCH * latches + CHECK, "a whole state");
            demand(utime >= 0 && seq >= 0 && isSound(data, size), "a sound state");
            for (int k = 0; status == 0 && k < count; k++) {
                data.position(first + k * EVENT);
                events.add(event(data));
            }
            for (int g = 0; status == 0 && g < grippers; g++) {
                data.position(first - GRIPPER * (grippers - g) + PLUNGER);
                plungers.add(plunger(data));
            }
        }

        private ProximityPlungers.Plunger plunger(ByteBuffer data) {
            final int phase = data.get();
            data.getInt(); // the wafer
            final double s = data.getDouble();
            return new ProximityPlungers.Plunger(utime, phase, s, data.getDouble());
        }

        private Event event(ByteBuffer data) {
            final Event event = new Event();
            event.utime = utime;
            event.kind = data.getInt();
            event.wafer = data.getInt();
            event.gripper = data.getInt();
            event.other = data.getInt();
            data.position(data.position() + 4 + 8 + 8); // status, the slice measured, height
            event.value = data.getDouble();
            event.limit = data.getDouble();
            data.position(data.position() + 2 * 4 + 3 * 8 + 1 + 3 * 8); // parts, place, face, dr
            event.planar = data.getDouble();
            event.z = data.getDouble();
            data.position(data.position() + 3 * 8);
            event.xy = data.getDouble();
            return event;
        }

        /** The check that lib/wire/messages.h describes. */
        private static boolean isSound(ByteBuffer data, int size) {
            final long written = data.getLong(size - CHECK);
            long h = 0x6a09e667f3bcc908L;
            for (int at = 0; at < size - CHECK; at += 8) {
                long word = 0;
                for (int k = 0; k < 8; k++) {
                    word = word << 8 | (at + k < size - CHECK ? data.get(at + k) & 0xff : 0);
                }
                h = (h ^ word) * 0x9e3779b97f4a7c15L;
                h ^= h >>> 32;
            }
            return written == 0 || written == (h == 0 ? 1 : h);
        }
    }

    /** One message of motion control. */
    static final class Progress {
        static final int BEGINS = 1;
        final long utime, run, request;
        final int phase, task, line, error;
        final String command, text;

        /** Throws like State. */
        Progress(ByteBuffer data) {
            demand(data.getLong() == mcs.LCM_FINGERPRINT, "motion control's");
            utime = data.getLong();
            data.getLong(); // the slice
            run = data.getLong();
            data.getLong(); // the layout
            phase = data.getInt();
            request = data.getLong();
            task = data.getInt();
            data.getLong(); // the axes and the grippers
            line = data.getInt();
            error = data.getInt();
            command = text(data);
            text = text(data);
            demand(!data.hasRemaining() && utime >= 0, "a whole message of motion control");
        }
    }

    private final ArrayList<Event> events = new ArrayList<>();
    private final ArrayList<Command> commands = new ArrayList<>();
    private ProximityPlungers plungers = new ProximityPlungers();
    private long lastSeq, missing;

    private static void demand(boolean good, String what) {
        if (!good) {
            throw new IllegalArgumentException("not " + what);
        }
    }

    private static int count(ByteBuffer data, int most) {
        final int count = data.getInt();
        demand(count >= 0 && count <= most, "a count");
        return count;
    }

    private static String text(ByteBuffer data) {
        final int length = data.getInt();
        demand(length >= 1 && length <= data.remaining(), "a text");
        final byte[] bytes = new byte[length];
        data.get(bytes);
        return new String(bytes, 0, length - 1, StandardCharsets.UTF_8);
    }

    /** Another run begins, or the current one again: keeps only commands of it that have begun already. */
    void begin(long run, long utime) {
        events.clear();
        plungers.clear();
        for (final Command command : commands) {
            command.run = command.run == 0 ? run : command.run;
        }
        commands.removeIf(command -> command.run != run || command.begin > utime || command.isOver());
        lastSeq = 0;
        missing = 0;
    }

    /** Takes the events of a state that comes for the first time. A state that is sent again has its events again. */
    void add(State message) {
        if (message.seq <= lastSeq) {
            return;
        }
        if (lastSeq > 0 && message.seq - lastSeq < 1_000_000_000L) {
            missing += message.seq - lastSeq - 1;
        }
        lastSeq = message.seq;
        events.addAll(message.events);
        forget(events);
        plungers.add(message.plungers);
    }

    /** Takes a command's progress. Messages may be missing: a command that continues or ends has begun. The first
     * command of a run begins before motion control has drawn the run's number. */
    void add(Progress message) {
        final boolean answers = message.request != 0 && message.phase >= Command.DONE;
        if (message.phase < Progress.BEGINS || message.phase > Command.FAILED || answers ||
            message.command.isEmpty()) {
            return;
        }
        Command command = last(message.task);
        final boolean same = command != null && (command.run == 0 || command.run == message.run) &&
                             command.line == message.line && command.text.equals(message.command);
        final boolean begins = message.phase == Progress.BEGINS;
        if (same && (begins ? !command.isOver() && command.begin == message.utime
                            : command.isOver() && command.end >= message.utime)) {
            return; // it is told again
        }
        if (!same || begins || command.isOver()) {
            command = new Command();
            command.run = message.run;
            command.begin = message.utime;
            command.task = message.task;
            command.line = message.line;
            command.text = message.command;
            commands.add(command);
            forget(commands);
        }
        command.run = message.run;
        command.end = Math.max(command.begin, message.utime);
        command.phase = message.phase;
        command.error = message.error;
        command.result = message.text;
    }

    /** The last command of a task, which runs one at a time; or null. */
    private Command last(int task) {
        for (int k = commands.size() - 1; k >= 0; k--) {
            if (commands.get(k).task == task) {
                return commands.get(k);
            }
        }
        return null;
    }

    static void forget(ArrayList<?> marks) {
        if (marks.size() > MOST) {
            marks.subList(0, marks.size() - MOST / 2).clear();
        }
    }

    /** The plunger of a gripper at that time, us; or null. */
    ProximityPlungers.Plunger plunger(int gripper, double time) {
        return plungers.at(gripper, time);
    }

    /** The number of the run's states that never came; their events are missing, too. */
    long missing() {
        return missing;
    }

    /** The marked events of a gripper between two times, us, in order. */
    List<Event> events(int gripper, double from, double to) {
        final List<Event> found = new ArrayList<>();
        for (final Event event : events) {
            if (event.utime >= from && event.utime <= to && event.concerns(gripper)) {
                found.add(event);
            }
        }
        return found;
    }

    /** The commands of a run that lie at least in part between two times, us. A command that is not over extends to
     * `to`, unless another one of its task has begun. */
    List<Command> commands(long run, double from, double to) {
        final List<Command> found = new ArrayList<>();
        for (int k = 0; k < commands.size(); k++) {
            final Command command = commands.get(k);
            final double end = command.isOver() ? command.end : next(k, to);
            if (command.run == run && end >= from && command.begin <= to) {
                found.add(command.copy(end));
            }
        }
        return found;
    }

    /** The time at which the next command of the same task begins; `otherwise` if there is none. */
    private double next(int place, double otherwise) {
        for (int k = place + 1; k < commands.size(); k++) {
            if (commands.get(k).task == commands.get(place).task) {
                return commands.get(k).begin;
            }
        }
        return otherwise;
    }

    /** A row for each command, so that commands shown at the same time have different rows. The commands are in the
     * order of their begin. */
    static int[] rows(List<Command> commands) {
        final int[] rows = new int[commands.size()];
        final ArrayList<Long> ends = new ArrayList<>();
        for (int k = 0; k < rows.length; k++) {
            while (rows[k] < ends.size() && ends.get(rows[k]) > commands.get(k).begin) {
                rows[k]++;
            }
            if (rows[k] == ends.size()) {
                ends.add(0L);
            }
            ends.set(rows[k], commands.get(k).end);
        }
        return rows;
    }

    /** A copy that later messages do not change. */
    ProximityMarks copy() {
        final ProximityMarks other = new ProximityMarks();
        other.events.addAll(events);
        other.plungers = plungers.copy();
        other.commands.addAll(commands);
        other.commands.replaceAll(command -> command.isOver() ? command : command.copy(command.end));
        other.lastSeq = lastSeq;
        other.missing = missing;
        return other;
    }
}
