package waferhand;

import java.util.Arrays;

/**
 * The proximity messages of one run, as far back as there is room. It needs no display, and may be filled and read by
 * different threads. Whatever a message contains, it is stored, or dropped and counted.
 */
final class ProximityHistory {
    /** Values of a gripper. */
    static final int Z = 0, XY = 1, PLANAR = 2, VALUES = 3;
    /** Bits of a gripper's flags. */
    static final int READY = 1, OPEN = 2, HOLDS = 4;

    private static final int FIRST_CAPACITY = 1 << 12;
    private static final int CAPACITY = 1 << 18;
    private static final int GRIPPERS = 8;
    /** A message older than the newest by more than this, us, is the same run played again, not a late one. */
    private static final double LATE = 1e6;
    /** So are this many late ones in a row. */
    private static final int LATE_IN_A_ROW = 50;
    /** Samples further apart than this, us, and than several usual steps, are not joined by a line. */
    private static final double GAP = 0.25e6;
    private static final double GAP_STEPS = 8;

    /** One gripper between two times, in columns of pixels. Of a column without samples the numbers are NaN. */
    static final class Strip {
        /** By value and column: the smallest, the largest, the first and the last number. */
        final double[][] low, high, first, last;
        /** By column: whether its first sample is to be joined with the one before it. */
        final boolean[] joined;
        /** By column: flags that are set in one of its samples; 0 without samples. */
        final int[] flags;
        /** By column: how many samples. */
        final int[] samples;

        Strip(int columns) {
            low = nothing(columns);
            high = nothing(columns);
            first = nothing(columns);
            last = nothing(columns);
            joined = new boolean[columns];
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

        private void add(int column, double[] values, int offset, int flag, boolean join) {
            if (samples[column]++ == 0) {
                joined[column] = join;
            }
            flags[column] |= flag;
            for (int v = 0; v < VALUES; v++) {
                final double value = values[offset + v];
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

    /** How the run goes, in numbers. */
    static final class Summary {
        long run, first, last, seen, unseen, late, refused;
        int grippers;
        double[] limits;
        /** As the layout has them; null where it is not known. */
        String[] names, valves;
    }

    private long[] utimes, seqs;
    private double[] values;
    private byte[] flags;
    private int[] wafers;
    private boolean[] joins;
    /** The oldest sample's place, and how many there are. */
    private int begin, count;
    private int grippers;

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
            begin(message);
        }
        append(message);
        return true;
    }

    /** Takes the names of grippers and wafers. */
    synchronized void add(ProximityNames names) {
        named = names;
    }

    /** Counts what could not be decoded. */
    synchronized void refuse() {
        refused++;
    }

    private boolean sameRun(proximity message) {
        return message.run == run && message.layout_hash == layout && message.gripper_count == grippers;
    }

    private boolean isLate(proximity message) {
        if (!started) {
            return false;
        }
        if (!sameRun(message)) {
            return hasPrevious && message.run == previousRun && message.run != run;
        }
        final long newest = utimes[place(count - 1)];
        return message.utime <= newest && (double)newest - message.utime <= LATE;
    }

    private boolean continues(proximity message) {
        return sameRun(message) && message.utime > utimes[place(count - 1)];
    }

    private void begin(proximity message) {
        if (seen > 0 && message.run != run) {
            previousRun = run;
            hasPrevious = true;
        }
        run = message.run;
        layout = message.layout_hash;
        started = true;
        begin = 0;
        count = 0;
        seen = 0;
        unseen = 0;
        late = 0;
        step = 0;
        if (grippers != message.gripper_count || utimes == null) {
            grippers = message.gripper_count;
            allocate(FIRST_CAPACITY);
        }
    }

    private void append(proximity message) {
        makeRoom();
        final int at = place(count);
        joins[at] = count > 0 && follows(message, place(count - 1));
        utimes[at] = message.utime;
        seqs[at] = message.seq;
        for (int g = 0; g < grippers; g++) {
            final int k = at * grippers + g;
            values[k * VALUES + Z] = Math.abs(message.dr_proj_z[g]);
            values[k * VALUES + XY] = message.dr_proj_xy_norm[g];
            values[k * VALUES + PLANAR] = message.n1_proj_n2[g];
            wafers[k] = message.wafer[g];
            flags[k] = (byte)((message.ready[g] == 1 ? READY : 0) | (message.valve[g] == 0 ? OPEN : 0) |
                              (message.holds[g] == 1 ? HOLDS : 0));
            if (message.wafer[g] < 0) {
                Arrays.fill(values, k * VALUES, (k + 1) * VALUES, Double.NaN);
            }
        }
        limits = new double[] {message.eps_projz, message.eps_projxy, message.eps_planar};
        count++;
        seen++;
    }

    /** Whether the message goes on from the sample there; counts the slices between them. */
    private boolean follows(proximity message, int before) {
        final double elapsed = (double)message.utime - utimes[before];
        final double slices = (double)message.seq - seqs[before];
        if (slices > 1 && slices < 1e9) {
            unseen += (long)slices - 1;
        }
        final boolean near = elapsed <= Math.max(GAP, GAP_STEPS * step);
        step = step == 0 ? elapsed : 0.9 * step + 0.1 * elapsed;
        return near;
    }

    private int place(int index) {
        return (begin + index) % utimes.length;
    }

    private void makeRoom() {
        if (count < utimes.length) {
            return;
        }
        if (utimes.length < CAPACITY) {
            allocate(2 * utimes.length); // it has not gone round yet: begin is 0
        } else {
            begin = place(1);
            count--;
        }
    }

    private void allocate(int capacity) {
        final boolean keep = count > 0;
        utimes = keep ? Arrays.copyOf(utimes, capacity) : new long[capacity];
        seqs = keep ? Arrays.copyOf(seqs, capacity) : new long[capacity];
        joins = keep ? Arrays.copyOf(joins, capacity) : new boolean[capacity];
        wafers = keep ? Arrays.copyOf(wafers, capacity * grippers) : new int[capacity * grippers];
        flags = keep ? Arrays.copyOf(flags, capacity * grippers) : new byte[capacity * grippers];
        values = keep ? Arrays.copyOf(values, capacity * grippers * VALUES)
                      : new double[capacity * grippers * VALUES];
    }

    /** A copy that later messages do not change. */
    synchronized ProximityHistory copy() {
        final ProximityHistory other = new ProximityHistory();
        if (utimes != null) {
            other.utimes = utimes.clone();
            other.seqs = seqs.clone();
            other.joins = joins.clone();
            other.wafers = wafers.clone();
            other.flags = flags.clone();
            other.values = values.clone();
        }
        other.begin = begin;
        other.count = count;
        other.grippers = grippers;
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
            if (utimes[place(middle)] < utime) {
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
        for (int i = Math.max(0, find(from) - 1); i < count; i++) {
            final int at = place(i);
            if (utimes[at] >= to) {
                break;
            }
            final int column = (int)Math.max(0, (utimes[at] - from) / (to - from) * columns);
            final int k = at * grippers + gripper;
            strip.add(Math.min(columns - 1, column), values, k * VALUES, flags[k], joins[at]);
        }
        return strip;
    }

    /** The newest sample that is not after a time, us; null if there is none. */
    synchronized Reading at(double utime) {
        final int after = count == 0 ? 0 : find(Math.nextUp(utime));
        if (after == 0) {
            return null;
        }
        final int at = place(after - 1);
        final Reading reading = new Reading();
        reading.utime = utimes[at];
        reading.seq = seqs[at];
        reading.values = new double[grippers][];
        reading.flags = new int[grippers];
        reading.wafer = new int[grippers];
        for (int g = 0; g < grippers; g++) {
            final int k = at * grippers + g;
            reading.values[g] = Arrays.copyOfRange(values, k * VALUES, (k + 1) * VALUES);
            reading.flags[g] = flags[k];
            reading.wafer[g] = wafers[k];
        }
        return reading;
    }

    synchronized Summary summary() {
        final Summary summary = new Summary();
        summary.run = run;
        summary.grippers = count == 0 ? 0 : grippers;
        summary.first = count == 0 ? 0 : utimes[begin];
        summary.last = count == 0 ? 0 : utimes[place(count - 1)];
        summary.seen = seen;
        summary.unseen = unseen;
        summary.late = late;
        summary.refused = refused;
        summary.limits = limits.clone();
        summary.names = new String[grippers];
        summary.valves = new String[grippers];
        for (int g = 0; g < grippers; g++) {
            final boolean known = isNamed() && g < named.grippers.length;
            summary.names[g] = known ? named.grippers[g] : null;
            summary.valves[g] = known ? named.valves[g] : null;
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

    private boolean isNamed() {
        return named != null && named.layout == layout;
    }
}
