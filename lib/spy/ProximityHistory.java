package waferhand;

import java.util.ArrayList;
import java.util.Arrays;
import java.util.List;

/** The proximity messages of one run, as far back as there is room, and the marks beside them. It needs no display, and
 * may be filled and read by different threads. Every message is stored, or dropped and counted, whatever it contains.
 */
final class ProximityHistory {
    /** Values of a gripper. */
    static final int Z = 0, XY = 1, PLANAR = 2, VALUES = 3;
    /** Bits of a gripper's flags. */
    static final int READY = 1, OPEN = 2, HOLDS = 4, FRONT = 64;
    /** Shifted left by the value's number, it says that the condition of that value holds. */
    static final int CONDITION = 8;
    private static final int MOMENTARY = READY | OPEN | HOLDS | FRONT;

    /** Samples: 87 minutes at one each 5 ms; 137 MB with eight grippers. */
    static final int CAPACITY = 1 << 20;
    private static final int CHUNK = 1 << 12;
    private static final int GRIPPERS = 16;
    /** If a message is older than the newest by more than this, us, the run is being played again; the message is not
     * late. */
    private static final double LATE = 1e6;
    /** This many late messages in a row mean it, too. */
    private static final int LATE_IN_A_ROW = 50;
    /** Samples further apart than this, us, and than several usual steps, are not joined by a line. */
    private static final double GAP = 0.25e6;
    private static final double GAP_STEPS = 8;

    /** One gripper between two times, in columns of pixels. In a column without samples the numbers are NaN. */
    static final class Strip {
        /** By value and column: the smallest, the largest, the first and the last number. */
        final double[][] low, high, first, last;
        /** By column: whether its first sample follows the one before it, and is of the same wafer. */
        final boolean[] joined, same;
        /** By column: flags that are set in one of its samples; 0 without samples. */
        final int[] flags;
        /** By column: the number of samples. */
        final int[] samples;

        Strip(int columns) {
            low = nothing(columns);
            high = nothing(columns);
            first = nothing(columns);
            last = nothing(columns);
            joined = new boolean[columns];
            same = new boolean[columns];
            flags = new int[columns];
            samples = new int[columns];
        }

        private static double[][] nothing(int columns) {
            final double[][] numbers = new double[VALUES][columns];
            for (final double[] row : numbers) {
                Arrays.fill(row, Double.NaN);
            }
            return numbers;
        }

        private void add(int column, Chunk chunk, int at, int gripper, boolean sameWafer) {
            final int k = at * chunk.grippers + gripper;
            if (samples[column]++ == 0) {
                joined[column] = chunk.joins[at];
                same[column] = chunk.joins[at] && sameWafer;
            }
            flags[column] |= chunk.flags[k] & MOMENTARY;
            for (int v = 0; v < VALUES; v++) {
                final double value = chunk.values[k * VALUES + v];
                if (samples[column] == 1) {
                    first[v][column] = value;
                }
                last[v][column] = value;
                if (!Double.isNaN(value)) {
                    low[v][column] = Double.isNaN(low[v][column]) ? value : Math.min(low[v][column], value);
                    high[v][column] =
                        Double.isNaN(high[v][column]) ? value : Math.max(high[v][column], value);
                }
            }
        }
    }

    /** All grippers at one time. */
    static final class Reading {
        long utime, seq;
        /** By gripper and value. */
        double[][] values;
        /** By gripper. */
        int[] flags, wafer;
    }

    /** The run's progress in numbers. */
    static final class Summary {
        long run, first, last, seen, unseen, late, refused, statesMissing;
        int grippers;
        double[] limits;
        /** The layout's names; null where they are not known. */
        String[] names, valves;
        /** The kinds of grips, as in ProximityPlungers. */
        int[] grips;
    }

    /** A group of samples. A full one never changes, so copies share it. */
    private static final class Chunk {
        final int grippers;
        final long[] utimes = new long[CHUNK], seqs = new long[CHUNK];
        final boolean[] joins = new boolean[CHUNK];
        /** By sample, gripper and the value's number. */
        final float[] values;
        final byte[] flags;
        final short[] wafers;

        Chunk(int grippers) {
            this.grippers = grippers;
            values = new float[CHUNK * grippers * VALUES];
            flags = new byte[CHUNK * grippers];
            wafers = new short[CHUNK * grippers];
        }

        /** A copy of its first samples. */
        Chunk copy(int count) {
            final Chunk other = new Chunk(grippers);
            System.arraycopy(utimes, 0, other.utimes, 0, count);
            System.arraycopy(seqs, 0, other.seqs, 0, count);
            System.arraycopy(joins, 0, other.joins, 0, count);
            System.arraycopy(values, 0, other.values, 0, count * grippers * VALUES);
            System.arraycopy(flags, 0, other.flags, 0, count * grippers);
            System.arraycopy(wafers, 0, other.wafers, 0, count * grippers);
            return other;
        }
    }

    private final ArrayList<Chunk> chunks = new ArrayList<>();
    private int count, grippers;
    private ProximityMarks marks = new ProximityMarks();

    private long run, layout, previousRun;
    private boolean started, hasPrevious;
    private int lateInARow;
    private double step;
    private double[] limits = {Double.NaN, Double.NaN, Double.NaN};
    private long seen, unseen, late, refused;
    private ProximityNames named;

    /** Takes a message. Returns whether it was stored. */
    synchronized boolean add(proximity message) {
        if (message.gripper_count < 1 || message.gripper_count > GRIPPERS || message.utime < 0) {
            refused++;
            return false;
        }
        if (isLate(message)) {
            late++;
            if (++lateInARow < LATE_IN_A_ROW) {
                return false;
            }
            started = false; // nothing else comes any more: it begins anew
        }
        lateInARow = 0;
        if (!started || !continues(message)) {
            begin(message.run, message.layout_hash, message.utime);
        }
        if (grippers != message.gripper_count) {
            chunks.clear();
            count = 0;
            grippers = message.gripper_count;
        }
        append(message);
        return true;
    }

    /** Takes a state's events. A new run begins with its first state, which comes before its proximity. */
    synchronized void add(ProximityMarks.State message) {
        final boolean same = started && message.run == run && message.layout == layout;
        if (!same && hasPrevious && message.run == previousRun) {
            return;
        }
        if (!same || count > 0 && (double)newest() - message.utime > LATE) {
            begin(message.run, message.layout, message.utime);
        }
        marks.add(message);
    }

    /** Takes a command's progress. */
    synchronized void add(ProximityMarks.Progress message) {
        marks.add(message);
    }

    /** Takes the names of grippers and wafers. */
    synchronized void add(ProximityNames names) {
        named = names;
    }

    /** Counts a message that could not be decoded. */
    synchronized void refuse() {
        refused++;
    }

    private boolean sameRun(proximity message) {
        return message.run == run && message.layout_hash == layout &&
            (count == 0 || message.gripper_count == grippers);
    }

    private boolean isLate(proximity message) {
        if (!started) {
            return false;
        }
        if (!sameRun(message)) {
            return hasPrevious && message.run == previousRun && message.run != run;
        }
        return count > 0 && message.utime <= newest() && (double)newest() - message.utime <= LATE;
    }

    private boolean continues(proximity message) {
        return sameRun(message) && (count == 0 || message.utime > newest());
    }

    private long newest() {
        return chunk(count - 1).utimes[count - 1 & CHUNK - 1];
    }

    private void begin(long newRun, long newLayout, long utime) {
        if ((seen > 0 || started) && newRun != run) {
            previousRun = run;
            hasPrevious = true;
        }
        run = newRun;
        layout = newLayout;
        started = true;
        chunks.clear();
        count = 0;
        seen = 0;
        unseen = 0;
        late = 0;
        step = 0;
        marks.begin(newRun, utime);
    }

    private Chunk chunk(int index) {
        return chunks.get(index / CHUNK);
    }

    private void append(proximity message) {
        makeRoom();
        final Chunk chunk = chunk(count);
        final int at = count % CHUNK;
        chunk.joins[at] = count > 0 && follows(message);
        chunk.utimes[at] = message.utime;
        chunk.seqs[at] = message.seq;
        for (int g = 0; g < grippers; g++) {
            put(message, g, chunk, at * grippers + g);
        }
        limits = new double[] {message.eps_projz, message.eps_projxy, message.eps_planar};
        count++;
        seen++;
    }

    private static void put(proximity message, int g, Chunk chunk, int k) {
        final double[] values = {Math.abs(message.dr_proj_z[g]), message.dr_proj_xy_norm[g],
                                 message.n1_proj_n2[g]};
        final double[] limits = {message.eps_projz, message.eps_projxy, message.eps_planar};
        final boolean some = message.wafer[g] >= 0;
        int flags = (message.ready[g] == 1 ? READY : 0) | (message.valve[g] == 0 ? OPEN : 0) |
                    (message.holds[g] == 1 ? HOLDS : 0) | (message.face[g] == 1 ? FRONT : 0);
        for (int v = 0; v < VALUES; v++) {
            chunk.values[k * VALUES + v] = some ? (float)values[v] : Float.NaN;
            flags |= some && ProximityChart.holds(v, values[v], limits[v]) ? CONDITION << v : 0;
        }
        chunk.wafers[k] = (short)Math.max(-1, Math.min(message.wafer[g], Short.MAX_VALUE));
        chunk.flags[k] = (byte)flags;
    }

    /** Whether the message continues from the newest sample; counts the slices between them. */
    private boolean follows(proximity message) {
        final double elapsed = (double)message.utime - newest();
        final double slices = (double)message.seq - chunk(count - 1).seqs[(count - 1) % CHUNK];
        if (slices > 1 && slices < 1e9) {
            unseen += (long)slices - 1;
        }
        final boolean near = elapsed <= Math.max(GAP, GAP_STEPS * step);
        step = step == 0 ? elapsed : 0.9 * step + 0.1 * elapsed;
        return near;
    }

    private void makeRoom() {
        if (count == CAPACITY) {
            chunks.remove(0);
            count -= CHUNK;
        }
        if (count == chunks.size() * CHUNK) {
            chunks.add(new Chunk(grippers));
        }
    }

    /** A copy that later messages do not change. It shares the full chunks, which do not change either. */
    synchronized ProximityHistory copy() {
        final ProximityHistory other = new ProximityHistory();
        other.chunks.addAll(chunks);
        if (count % CHUNK > 0) {
            other.chunks.set(chunks.size() - 1, chunk(count - 1).copy(count % CHUNK));
        }
        other.count = count;
        other.grippers = grippers;
        other.marks = marks.copy();
        other.run = run;
        other.layout = layout;
        other.started = started;
        other.limits = limits;
        other.seen = seen;
        other.unseen = unseen;
        other.late = late;
        other.refused = refused;
        other.named = named;
        return other;
    }

    /** The number of the first sample at utime or later; count if there is none. */
    private int find(double utime) {
        int low = 0;
        int high = count;
        while (low < high) {
            final int middle = (low + high) >>> 1;
            if (chunk(middle).utimes[middle % CHUNK] < utime) {
                low = middle + 1;
            } else {
                high = middle;
            }
        }
        return low;
    }

    /** A gripper's samples from one time, us, to before another, in columns. One sample before them is put into the
     * first column, so that a line comes in from the left. */
    synchronized Strip strip(int gripper, double from, double to, int columns) {
        final Strip strip = new Strip(columns);
        if (count == 0 || gripper < 0 || gripper >= grippers || !(to > from)) {
            return strip;
        }
        int before = -1;
        for (int i = Math.max(0, find(from) - 1); i < count; i++) {
            final Chunk chunk = chunk(i);
            final int at = i % CHUNK;
            if (chunk.utimes[at] >= to) {
                break;
            }
            final int wafer = chunk.wafers[at * grippers + gripper];
            final int column = (int)Math.max(0, (chunk.utimes[at] - from) / (to - from) * columns);
            strip.add(Math.min(columns - 1, column), chunk, at, gripper, wafer == before);
            before = wafer;
        }
        return strip;
    }

    /** The events of a gripper that lie between two times, us, in order. */
    synchronized List<ProximityMarks.Event> events(int gripper, double from, double to) {
        return marks.events(gripper, from, to);
    }

    /** The commands that lie at least in part between two times, us, in order. */
    synchronized List<ProximityMarks.Command> commands(double from, double to) {
        return marks.commands(run, from, to);
    }

    /** The plunger of a gripper at that time, us; or null. */
    synchronized ProximityPlungers.Plunger plunger(int gripper, double time) {
        return marks.plunger(gripper, time);
    }

    /** The newest sample that is not after a time, us; null if there is none. */
    synchronized Reading at(double utime) {
        final int after = count == 0 ? 0 : find(Math.nextUp(utime));
        if (after == 0) {
            return null;
        }
        final Chunk chunk = chunk(after - 1);
        final int at = (after - 1) % CHUNK;
        final Reading reading = new Reading();
        reading.utime = chunk.utimes[at];
        reading.seq = chunk.seqs[at];
        reading.values = new double[grippers][VALUES];
        reading.flags = new int[grippers];
        reading.wafer = new int[grippers];
        for (int g = 0; g < grippers; g++) {
            final int k = at * grippers + g;
            for (int v = 0; v < VALUES; v++) {
                reading.values[g][v] = chunk.values[k * VALUES + v];
            }
            reading.flags[g] = chunk.flags[k];
            reading.wafer[g] = chunk.wafers[k];
        }
        return reading;
    }

    synchronized Summary summary() {
        final Summary summary = new Summary();
        summary.run = run;
        summary.grippers = count == 0 ? 0 : grippers;
        summary.first = count == 0 ? 0 : chunk(0).utimes[0];
        summary.last = count == 0 ? 0 : newest();
        summary.seen = seen;
        summary.unseen = unseen;
        summary.late = late;
        summary.refused = refused;
        summary.statesMissing = marks.missing();
        summary.limits = limits.clone();
        summary.names = new String[grippers];
        summary.valves = new String[grippers];
        summary.grips = new int[grippers];
        for (int g = 0; g < grippers; g++) {
            final boolean known = isNamed() && g < named.grippers.length;
            summary.names[g] = known ? named.grippers[g] : null;
            summary.valves[g] = known ? named.valves[g] : null;
            summary.grips[g] = known ? named.grips[g] : ProximityPlungers.VACUUM;
        }
        return summary;
    }

    /** A wafer's name, or its number; null for none. */
    synchronized String waferName(int wafer) {
        if (wafer < 0) {
            return null;
        }
        return isNamed() && wafer < named.wafers.length ? named.wafers[wafer] : "wafer " + wafer;
    }

    /** A gripper's name, or its number; null for none. */
    synchronized String gripperName(int gripper) {
        if (gripper < 0) {
            return null;
        }
        final boolean known = isNamed() && gripper < named.grippers.length;
        return known ? named.grippers[gripper] : "gripper " + gripper;
    }

    private boolean isNamed() {
        return named != null && named.layout == layout;
    }
}
