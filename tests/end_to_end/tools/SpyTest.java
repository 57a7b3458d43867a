package waferhand;

import java.awt.Graphics2D;
import java.awt.event.MouseEvent;
import java.awt.image.BufferedImage;
import java.io.ByteArrayOutputStream;
import java.io.DataOutputStream;
import java.io.EOFException;
import java.io.IOException;
import java.util.ArrayList;
import java.util.List;
import java.util.Random;
import javax.swing.Action;
import javax.swing.JButton;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMEncodable;
import lcm.logging.Log;
import lcm.spy.SpyPlugin;
import lcm.util.ClassDiscoverer;

/** What tests/end_to_end/spy runs: lcm-spy's views without lcm-spy and without a display. */
final class SpyTest {
    private static final long RUN = 0x1234;
    private static final double AT_END = Double.MAX_VALUE;
    private static int checks;

    private SpyTest() {
    }

    private static void check(boolean good, String what) {
        checks++;
        if (!good) {
            throw new AssertionError(what);
        }
    }

    private static proximity message(long run, long seq) {
        final proximity message = new proximity();
        message.run = run;
        message.seq = seq;
        message.utime = seq * 1000;
        message.layout_hash = 7;
        message.eps_projz = 0.5;
        message.eps_projxy = 50;
        message.eps_planar = 0.99;
        message.gripper_count = 2;
        for (int g = 0; g < message.valve.length; g++) {
            message.dr_proj_z[g] = -0.001 * seq;
            message.dr_proj_xy_norm[g] = seq + g;
            message.n1_proj_n2[g] = 0.999;
            message.valve[g] = 1;
        }
        return message;
    }

    private static ProximityHistory filled(long run, long from, long to) {
        final ProximityHistory history = new ProximityHistory();
        fill(history, run, from, to);
        return history;
    }

    private static void fill(ProximityHistory history, long run, long from, long to) {
        for (long seq = from; seq <= to; seq++) {
            check(history.add(message(run, seq)), "in order");
        }
    }

    /** A state with an event of each of these kinds, by gripper 1 of wafer 0. */
    private static state step(long run, long seq, int... kinds) {
        final state message = new state();
        message.latching = new latching();
        message.latching.waiting = new latch[0];
        message.latching.latches = new latch[0];
        message.run = run;
        message.seq = seq;
        message.utime = seq * 1000;
        message.layout_hash = 7;
        message.wafer_count = 1;
        message.wafers = new wafer_state[] {new wafer_state()};
        message.gripper_count = 2;
        message.grippers = new gripper_state[] {gripper(), gripper()};
        message.event_count = kinds.length;
        message.events = new event[kinds.length];
        for (int k = 0; k < kinds.length; k++) {
            message.events[k] = new event();
            message.events[k].kind = kinds[k];
            message.events[k].gripper = 1;
            message.events[k].other = kinds[k] == 2 ? 0 : -1;
            message.events[k].measured = new measurement();
            message.events[k].measured.dr_proj_z = -0.25;
            message.events[k].measured.dr_proj_xy_norm = 12.5;
            message.events[k].measured.n1_proj_n2 = 0.9996;
        }
        message.faults = new fault_slot[0];
        message.sample_count = 3;
        message.samples = new int[3];
        message.door_count = 2;
        message.doors = new double[] {0, 250};
        return message;
    }

    private static gripper_state gripper() {
        final gripper_state message = new gripper_state();
        message.approach = new encounter();
        message.approach.measured = new measurement();
        message.contest = new encounter();
        message.contest.measured = new measurement();
        return message;
    }

    private static mcs progress(long run, long seq, int phase, String command) {
        final mcs message = new mcs();
        message.run = run;
        message.seq = seq;
        message.utime = seq * 1000;
        message.phase = phase;
        message.line = 4;
        message.error = phase == 4 ? 32 : 0;
        message.command = command;
        message.text = phase == 4 ? "no wafer was taken" : "";
        return message;
    }

    // ---------------------------------------------------------------------------------------- the plugin
    private static void findsPlugin() throws Exception {
        final List<Class<?>> found = new ArrayList<>();
        ClassDiscoverer.findClasses((jar, type) -> {
            for (final Class<?> implemented : type.getInterfaces()) {
                if (implemented.equals(SpyPlugin.class)) {
                    found.add(type);
                }
            }
        });
        found.sort(java.util.Comparator.comparing(Class::getName));
        check(found.size() == 3, "three plugins, not " + found);
        findsCentrings((CentringPlugin)found.get(0).getConstructor().newInstance());
        findsEdgeScans((EdgeScanPlugin)found.get(1).getConstructor().newInstance());
        final SpyPlugin plugin = (SpyPlugin)found.get(2).getConstructor().newInstance();
        check(plugin.canHandle(proximity.LCM_FINGERPRINT), "takes proximity");
        check(!plugin.canHandle(state.LCM_FINGERPRINT) && !plugin.canHandle(0), "takes nothing else");
        check(plugin.getAction(null, null).getValue(Action.NAME) != null, "says its name");
        collectsFromTheStart((ProximityPlugin)plugin);
    }

    private static void findsEdgeScans(EdgeScanPlugin plugin) throws IOException, InterruptedException {
        check(plugin.canHandle(edge_scan.LCM_FINGERPRINT), "takes edge scans");
        check(!plugin.canHandle(proximity.LCM_FINGERPRINT) && !plugin.canHandle(0), "and nothing else");
        check(plugin.getAction(null, null).getValue(Action.NAME) != null, "says its name, too");
        LCM.getSingleton().publish("WAFERHAND_EDGE_SCAN", part(1, 1, 1, 10));
        for (int k = 0; k < 500 && plugin.history("WAFERHAND_EDGE_SCAN").scans().isEmpty(); k++) {
            Thread.sleep(10);
        }
        check(plugin.history("WAFERHAND_EDGE_SCAN").scans().size() == 1,
              "collects scans before a view is opened");
    }

    private static void findsCentrings(CentringPlugin plugin) throws IOException, InterruptedException {
        check(plugin.canHandle(centring.LCM_FINGERPRINT), "takes centrings");
        check(!plugin.canHandle(edge_scan.LCM_FINGERPRINT) && !plugin.canHandle(0), "and nothing else");
        check(plugin.getAction(null, null).getValue(Action.NAME) != null, "says its name as well");
        LCM.getSingleton().publish("WAFERHAND_LATCH", pass(1, 70, 0));
        for (int k = 0; k < 500 && plugin.history().list().isEmpty(); k++) {
            Thread.sleep(10);
        }
        check(plugin.history().list().size() == 1, "collects passes before a view is opened");
    }

    /** A pass with two crossings and so many centres. */
    private static centring pass(int number, int status, int centres) {
        final centring message = new centring();
        message.run = RUN;
        message.number = number;
        message.status = status;
        message.crossing_count = 2;
        message.crossings = new crossing[] {new crossing(), new crossing()};
        message.crossings[0].x = 150;
        message.crossings[1].x = -150;
        message.crossings[1].edge = 1;
        message.centre_count = centres;
        message.centres = new centre[centres];
        for (int i = 0; i < centres; i++) {
            message.centres[i] = new centre();
            message.centres[i].radius = 150;
        }
        return message;
    }

    private static void refusesPasses() {
        final CentringPass.History history = new CentringPass.History();
        check(history.add(pass(1, 70, 0)) && history.add(pass(2, 0, 1)), "passes are kept");
        check(history.add(pass(2, 75, 2)) && history.list().size() == 2, "one that comes again replaces");
        check(!history.list().get(1).sure, "by what came last");
        final centring bad = pass(3, 0, 1);
        bad.centres[0].radius = Double.NaN;
        check(!history.add(bad), "no radius is no circle");
        bad.centres[0].radius = 150;
        bad.crossings[1].y = Double.NaN;
        check(!history.add(bad) && history.lost().equals("2 messages refused"), "nor is NaN a place");
        for (int number = 4; number < 400; number++) {
            history.add(pass(number, 0, 1));
        }
        check(history.list().size() == CentringPass.History.MOST, "the last passes stay");
    }

    /** The passes of the log 13_centring.lua: sure, sure with the notch in a beam, and not sure. */
    private static void showsPasses(String path) throws IOException {
        final CentringPass.History history = new CentringPass.History();
        final CentringView view = new CentringView(history);
        for (final int size : new int[] {0, 1, 50, 700}) {
            picture(view, size, size);
        }
        final Log log = new Log(path, "r");
        try {
            while (true) {
                final Log.Event event = log.readNext();
                if (event.channel.equals("WAFERHAND_LATCH")) {
                    history.add(new centring(new LCMDataInputStream(event.data)));
                }
            }
        } catch (EOFException end) {
            log.close();
        }
        final java.util.List<CentringPass> list = history.list();
        check(list.size() == 3 && list.get(0).sure && list.get(1).sure && !list.get(2).sure, "three passes");
        check(list.get(1).lines.get(1).startsWith("centre: x -0.5997, y 2.1002 mm on the blade"),
              list.get(1).lines.get(1));
        check(list.get(1).told.crossings[0].use == 1 && Math.abs(list.get(1).residual(0, 0) + 915.6) < 0.1,
              "the notch is 0.9 mm deep there");
        check(list.get(2).lines.get(0).equals("not sure: 75 CENTRE_NOT_SURE"), list.get(2).lines.get(0));
        check(list.get(2).lines.get(1).startsWith("likelier place: ") &&
                  list.get(2).lines.get(2).startsWith("other place: "),
              "neither is called the centre");
        final BufferedImage unsure = picture(view, 1000, 700);
        check(count(unsure, ProximityChart.LINE) > 100 && count(unsure, ProximityChart.LIMIT) > 100,
              "both places are drawn");
        view.step(-1);
        final BufferedImage sure = picture(view, 1000, 700);
        check(!same(sure, unsure) && count(sure, ProximityChart.GOOD) > 20, "an older pass can be seen");
        view.step(1);
        check(same(unsure, picture(view, 1000, 700)), "and the newest pass again");
        history.add(pass(9, 70, 0));
        check(count(picture(view, 1000, 700), ProximityChart.LINE) < 10, "no place, no circle");
        for (final int size : new int[] {0, 1, 10, 100, 800}) {
            picture(view, size, 900);
            picture(view, 900, size);
        }
    }

    /** A part of a scan whose parts all have so many samples. */
    private static edge_scan part(int number, int part, int parts, int samples) {
        final edge_scan message = new edge_scan();
        message.run = RUN;
        message.number = number;
        message.part = part;
        message.parts = parts;
        message.begin = (part - 1) * samples;
        message.taken = parts * samples;
        message.count = message.taken;
        message.turn_samples = message.taken;
        message.pixels = 4000;
        message.pixel = 0.007;
        message.inner = 136;
        message.verdict = 76;
        message.mark_at = Double.NaN;
        message.sample_count = samples;
        message.samples = new int[samples];
        message.residual = new float[samples];
        message.counts = new byte[samples];
        java.util.Arrays.fill(message.samples, 2000);
        message.samples[samples - 1] = -1;
        message.residual[samples - 1] = Float.NaN;
        message.line_count = 1;
        message.lines = new String[] {"not sure: of 3 \u00c2\u00b5m"};
        return message;
    }

    private static void putsScansTogether() {
        final EdgeScan.History history = new EdgeScan.History();
        history.add(part(1, 2, 2, 50));
        check(history.scans().isEmpty(), "half a scan is none");
        history.add(part(1, 1, 2, 50));
        check(history.scans().size() == 1, "parts come in any order");
        final EdgeScan scan = history.scans().get(0);
        check(!scan.sure && scan.lines.get(0).equals("not sure: of 3 \u00b5m"),
              "the words as they are meant");
        check(scan.taken == 100 && Double.isNaN(scan.rho[49]) && !Double.isNaN(scan.rho[50]),
              "what is missing is a gap");
        check(Math.abs(scan.rho[0] - (136 + 2000.5 * 0.007)) < 1e-12, "rho is the sensor's");
        history.add(part(2, 1, 2, 50));
        history.add(part(3, 1, 1, 50));
        check(history.scans().size() == 2 && history.lost().startsWith("1 scans came in part"),
              "half a scan is told");
        for (int number = 4; number < 200; number++) {
            history.add(part(number, 1, 1, 10));
        }
        check(history.scans().size() == EdgeScan.History.MOST && history.scans().get(99).number == 199,
              "the last ones stay");
        final edge_scan bad = part(5, 3, 2, 10);
        check(!history.add(bad), "a part beyond the parts is refused");
        bad.part = 1;
        bad.begin = Integer.MAX_VALUE;
        check(!history.add(bad) && history.lost().endsWith("2 messages refused"),
              "so is a place beyond the samples");
    }

    /** A scan of the log 09_edge_scan.lua, whose wafer lies at (1.5, -0.8), turned by 37 degrees. */
    private static void showsAScan(String path) throws IOException {
        final EdgeScan.History history = new EdgeScan.History();
        final EdgeScanView view = new EdgeScanView(history);
        for (final int size : new int[] {0, 1, 50, 700}) {
            picture(view, size, size);
        }
        final Log log = new Log(path, "r");
        try {
            while (true) {
                final Log.Event event = log.readNext();
                if (event.channel.equals("WAFERHAND_EDGE_SCAN")) {
                    history.add(new edge_scan(new LCMDataInputStream(event.data)));
                }
            }
        } catch (EOFException end) {
            log.close();
        }
        check(history.scans().size() == 1, "the log has a scan");
        final EdgeScan scan = history.scans().get(0);
        check(scan.sure && scan.lines.get(0).equals("sure") && scan.lines.size() == 5,
              "which is sure: " + scan.lines);
        check(scan.lines.get(2).matches("notch: towards 3[67]\\.\\d+\u00b0, .*"), scan.lines.get(2));
        check(scan.isNotch && Math.abs(scan.markAt - 37) < 1, "its notch");
        for (int i = 0; i < scan.taken; i++) {
            check(Math.abs(scan.rho[i] - scan.residual[i] / 1000 - scan.circle(scan.theta[i])) < 1e-6,
                  "residuals are of the circle");
        }
        check(count(picture(view, 1000, 700), ProximityChart.LINE) > 2000, "samples are drawn");
        check(count(picture(view, 1000, 700), ProximityChart.LIMIT) > 50, "and the circle");
        final BufferedImage sure = picture(view, 1000, 700);
        history.add(part(7, 1, 1, 50));
        final BufferedImage unsure = picture(view, 1000, 700);
        check(!same(sure, unsure), "the newest is shown");
        view.step(-1);
        check(!same(unsure, picture(view, 1000, 700)), "an older one can be");
        view.step(1);
        check(same(unsure, picture(view, 1000, 700)), "and the newest again");
        view.dispatchEvent(new MouseEvent(view, MouseEvent.MOUSE_MOVED, 0, 0, 500, 300, 0, false));
        check(!same(unsure, picture(view, 1000, 700)), "the mouse tells a sample");
        for (final int size : new int[] {0, 1, 10, 100, 800}) {
            picture(view, size, 900);
            picture(view, 900, size);
        }
    }

    private static boolean same(BufferedImage a, BufferedImage b) {
        return java.util.Arrays.equals(a.getRGB(0, 0, 1000, 700, null, 0, 1000),
                                       b.getRGB(0, 0, 1000, 700, null, 0, 1000));
    }

    /** No view has been opened. */
    private static void collectsFromTheStart(ProximityPlugin plugin)
        throws IOException, InterruptedException {
        LCM.getSingleton().publish("WAFERHAND_PROXIMITY", message(RUN, 1));
        LCM.getSingleton().publish("OTHER_PROXIMITY", message(RUN + 1, 1));
        for (int k = 0; k < 500 && plugin.history("OTHER_PROXIMITY").summary().seen == 0; k++) {
            Thread.sleep(10);
        }
        check(plugin.history("WAFERHAND_PROXIMITY").summary().seen == 1, "collects before a view is opened");
        check(plugin.history("OTHER_PROXIMITY").summary().run == RUN + 1, "other channels apart");
        for (int k = 0; k < 100; k++) {
            check(plugin.history("C" + k + "_PROXIMITY").summary().seen == 0, "no more than a few");
        }
    }

    private static byte[] encode(LCMEncodable message) throws IOException {
        final ByteArrayOutputStream bytes = new ByteArrayOutputStream();
        message.encode(new DataOutputStream(bytes));
        return bytes.toByteArray();
    }

    private static cell names() {
        final cell message = new cell();
        message.layout_hash = 7;
        message.layout = "layouts/größe.lua";
        message.gripper_count = 1;
        message.grips = new byte[] {1};
        message.gripper_names = new String[] {"EE"};
        message.valve_names = new String[] {"eeVacValve[0]"};
        final station taught = new station();
        taught.name = "A";
        message.station_count = 2;
        message.stations = new station[] {taught, taught};
        message.wafer_count = 1;
        message.wafer_names = new String[] {"Wafer 1"};
        message.wafers = new wafer_state[] {new wafer_state()};
        message.edge_count = 1;
        message.edges = new edge_grip[] {new edge_grip()};
        final door gate = new door();
        gate.name = "gate";
        message.door_count = 2;
        message.doors = new door[] {gate, gate};
        return message;
    }

    private static void decodes() throws IOException {
        final ProximityPlugin.Collector feed = new ProximityPlugin.Collector();
        final ProximityHistory history = feed.history("WAFERHAND_PROXIMITY");
        feed.messageReceived(null, "WAFERHAND_PROXIMITY", new LCMDataInputStream(encode(message(RUN, 1))));
        check(history.summary().seen == 1 && history.summary().names[0] == null, "no names yet");
        feed.messageReceived(null, "WAFERHAND_CELL", new LCMDataInputStream(encode(names())));
        final ProximityHistory.Summary summary = history.summary();
        check(summary.names[0].equals("EE") && summary.valves[0].equals("eeVacValve[0]"), "names");
        check(summary.names[1] == null && summary.valves[1] == null, "a name too few");
        check(history.waferName(0).equals("Wafer 1") && history.waferName(5).equals("wafer 5"),
              "wafers' names");
        check(history.waferName(-1) == null, "no wafer");
    }

    private static void survivesGarbage() throws IOException {
        final ProximityPlugin.Collector feed = new ProximityPlugin.Collector();
        final ProximityHistory history = feed.history("WAFERHAND_PROXIMITY");
        fill(history, RUN, 1, 10);
        final Random random = new Random(1);
        final String[] channels = {"WAFERHAND_PROXIMITY", "WAFERHAND_CELL", "WAFERHAND_STATE",
                                   "WAFERHAND_MCS"};
        final byte[][] whole = {encode(message(RUN, 11)), encode(names()), encode(step(RUN, 11, 0, 3, 11)),
                                encode(progress(RUN, 11, 1, "GET A 1"))};
        for (int k = 0; k < 20000; k++) {
            final byte[] bytes = whole[k % 4].clone();
            for (int flips = random.nextInt(4); flips >= 0; flips--) {
                bytes[random.nextInt(bytes.length)] ^= (byte)(1 << random.nextInt(8));
            }
            final int length = random.nextInt(3) == 0 ? random.nextInt(bytes.length) : bytes.length;
            feed.messageReceived(null, channels[k % 4], new LCMDataInputStream(bytes, 0, length));
            if (k % 500 == 0) {
                paint(new ProximityView(history), 300, 300);
            }
        }
        check(history.summary().refused > 1000, "counts garbage");
        for (long seq = 20; seq < 200; seq++) {
            history.add(message(RUN, seq));
        }
        check(history.summary().run == RUN && history.at(AT_END).seq == 199, "the run goes on after garbage");
    }

    // --------------------------------------------------------------------------------------- the history
    private static void keepsOrder() {
        final ProximityHistory history = filled(RUN, 1, 100);
        check(!history.add(message(RUN, 100)) && !history.add(message(RUN, 60)), "doubled and late ones");
        check(history.add(message(RUN, 104)), "after a loss");
        final ProximityHistory.Summary summary = history.summary();
        check(summary.seen == 101 && summary.late == 2 && summary.unseen == 3, "counts");
        check(summary.first == 1000 && summary.last == 104000, "times");
        check(history.at(60500).seq == 60 && history.at(999) == null, "looks up");
        check(history.at(AT_END).values[1][ProximityHistory.XY] == 105, "the newest");
    }

    private static void beginsAnew() {
        ProximityHistory history = filled(RUN, 1, 100);
        history.add(message(RUN + 1, 1));
        check(history.summary().run == RUN + 1 && history.summary().seen == 1, "a new run clears");
        check(!history.add(message(RUN, 101)) && history.summary().run == RUN + 1,
              "a late one of the old run");

        history = filled(RUN, 1, 5000);
        history.add(message(RUN, 1));
        check(history.summary().seen == 1 && history.summary().last == 1000, "a replay clears");

        history = filled(RUN, 1, 500);
        for (long seq = 1; seq <= 100; seq++) {
            history.add(message(RUN, seq));
        }
        check(history.summary().last == 100000 && history.summary().seen < 100,
              "a short run's replay clears");

        history = filled(RUN, 1, 5);
        final proximity other = message(RUN, 6);
        other.gripper_count = 16;
        history.add(other);
        check(history.summary().grippers == 16 && history.summary().seen == 1, "other grippers clear");
    }

    private static void refuses() {
        final ProximityHistory history = filled(RUN, 1, 3);
        for (final int count : new int[] {0, -1, 17, Integer.MAX_VALUE}) {
            final proximity bad = message(RUN, 4);
            bad.gripper_count = count;
            check(!history.add(bad), "a bad count");
        }
        final proximity early = message(RUN, 4);
        early.utime = Long.MIN_VALUE;
        check(!history.add(early), "a bad time");
        check(history.summary().refused == 5 && history.summary().seen == 3, "counts");

        final proximity far = message(RUN, 4);
        far.utime = Long.MAX_VALUE;
        far.seq = Long.MIN_VALUE;
        history.add(far);
        history.add(message(RUN, 5));
        check(history.summary().last == 5000, "a time beyond all clears itself");
    }

    private static void take(ProximityPlugin.Collector feed, String channel, LCMEncodable message)
        throws IOException {
        feed.messageReceived(null, channel, new LCMDataInputStream(encode(message)));
    }

    private static String kinds(ProximityHistory history, int gripper) {
        final StringBuilder text = new StringBuilder();
        for (final ProximityMarks.Event event : history.events(gripper, 0, AT_END)) {
            text.append(event.utime / 1000).append(' ').append(event.name()).append(", ");
        }
        return text.toString();
    }

    private static String lines(ProximityHistory history) {
        final StringBuilder text = new StringBuilder();
        for (final ProximityMarks.Command command : history.commands(0, 1e9)) {
            text.append(command.text).append(' ').append(command.begin / 1000).append('-');
            text.append(command.end / 1000).append(command.phase == 4 ? " failed" : "").append(", ");
        }
        return text.toString();
    }

    /** Events come with states, of which some are missing and some come twice. */
    private static void marksEvents() throws IOException {
        final ProximityPlugin.Collector feed = new ProximityPlugin.Collector();
        final ProximityHistory history = feed.history("WAFERHAND_STATE");
        take(feed, "WAFERHAND_STATE", step(RUN, 1));
        take(feed, "WAFERHAND_STATE", step(RUN, 2, 0, 3));
        take(feed, "WAFERHAND_STATE", step(RUN, 2, 0, 3));
        take(feed, "WAFERHAND_STATE", step(RUN, 1, 1));
        fill(history, RUN, 1, 100);
        take(feed, "WAFERHAND_STATE", step(RUN, 6, 2, 99));
        check(kinds(history, 1).equals("2 picked, 2 near miss, 6 handed over, 6 event of kind 99, "),
              kinds(history, 1));
        check(kinds(history, 0).equals("6 handed over, "), "what another gripper has a part in");
        check(history.summary().statesMissing == 3 && history.summary().seen == 100, "counts");
        final ProximityMarks.Event event = history.events(1, 0, AT_END).get(0);
        check(event.values().equals("|z| 0.250 mm, |xy| 12.50 mm, n1\u00b7n2 0.999600"), event.values());
        check(history.events(1, 3000, AT_END).size() == 2, "between two times");

        final ProximityHistory copy = history.copy();
        final state refused = step(RUN, 7, 5);
        refused.status = 3;
        take(feed, "WAFERHAND_STATE", refused);
        take(feed, "WAFERHAND_STATE", step(RUN + 1, 1, 11));
        take(feed, "WAFERHAND_STATE", step(RUN, 8, 1));
        check(kinds(history, 1).equals("1 hit, "), "a new run has its own events: " + kinds(history, 1));
        check(history.add(message(RUN + 1, 1)) && kinds(history, 1).equals("1 hit, "), "and keeps them");
        check(copy.events(1, 0, AT_END).size() == 4, "a copy stays");

        fill(history, RUN + 1, 2, 5000);
        take(feed, "WAFERHAND_STATE", step(RUN + 1, 1, 0));
        check(kinds(history, 1).equals("1 picked, ") && history.summary().seen == 0, "a replay begins anew");
        for (long seq = 2; seq < 2 * ProximityMarks.MOST; seq++) {
            history.add(new ProximityMarks.State(java.nio.ByteBuffer.wrap(encode(step(RUN + 1, seq, 0)))));
        }
        check(history.events(1, 0, AT_END).size() <= ProximityMarks.MOST, "no more than there is room for");
        check(history.events(1, 2e6 * ProximityMarks.MOST / 1000 - 1000, AT_END).size() > 0,
              "the newest stay");
    }

    private static mcs ofTask(int task, mcs message) {
        message.task = task;
        return message;
    }

    /** Each task has commands of its own, at the same time as others. */
    private static void marksTasks() throws IOException {
        final ProximityPlugin.Collector feed = new ProximityPlugin.Collector();
        final ProximityHistory history = feed.history("WAFERHAND_MCS");
        fill(history, RUN, 1, 900);
        take(feed, "WAFERHAND_MCS", ofTask(0, progress(RUN, 0, 1, "GET A 1")));
        take(feed, "WAFERHAND_MCS", ofTask(1, progress(RUN, 50, 1, "ALIGN P 90")));
        take(feed, "WAFERHAND_MCS", ofTask(2, progress(RUN, 60, 1, "ALIGN Q 90")));
        take(feed, "WAFERHAND_MCS", ofTask(0, progress(RUN, 100, 3, "GET A 1")));
        final ProximityHistory copy = history.copy();
        take(feed, "WAFERHAND_MCS", ofTask(2, progress(RUN, 150, 4, "ALIGN Q 90")));
        take(feed, "WAFERHAND_MCS", ofTask(0, progress(RUN, 160, 1, "PUT Q 1")));
        take(feed, "WAFERHAND_MCS", ofTask(1, progress(RUN, 200, 9, "ALIGN P 90")));
        take(feed, "WAFERHAND_MCS", ofTask(1, progress(RUN, 220, 3, "ALIGN P 90")));
        take(feed, "WAFERHAND_MCS", ofTask(0, progress(RUN, 240, 3, "PUT Q 1")));
        check(lines(history).equals(
                  "GET A 1 0-100, ALIGN P 90 50-220, ALIGN Q 90 60-150 failed, PUT Q 1 160-240, "),
              lines(history));
        check(java.util.Arrays.equals(ProximityMarks.rows(history.commands(0, 1e9)), new int[] {0, 1, 2, 0}),
              "none covers another one");
        check(lines(copy).startsWith("GET A 1 0-100, ALIGN P 90 50-1000000, ALIGN Q 90 60-1000000, "),
              "a copy stays: " + lines(copy));
    }

    /** Commands come with motion control's messages, of which some are missing. */
    private static void marksCommands() throws IOException {
        final ProximityPlugin.Collector feed = new ProximityPlugin.Collector();
        final ProximityHistory history = feed.history("WAFERHAND_MCS");
        take(feed, "WAFERHAND_MCS", progress(0, 0, 0, ""));
        take(feed, "WAFERHAND_MCS", progress(0, 0, 1, "GET A 1")); // no run's number has been drawn yet
        fill(history, RUN, 1, 900);
        check(lines(history).equals("GET A 1 0-1000000, "), "goes on: " + lines(history));
        take(feed, "WAFERHAND_MCS", progress(RUN, 50, 2, "GET A 1"));
        take(feed, "WAFERHAND_MCS", progress(RUN, 100, 3, "GET A 1"));
        take(feed, "WAFERHAND_MCS", progress(RUN, 100, 3, "GET A 1"));
        final mcs answer = progress(RUN, 100, 3, "get a 1");
        answer.request = 17;
        take(feed, "WAFERHAND_MCS", answer);                           // to a request: not another command
        take(feed, "WAFERHAND_MCS", progress(RUN, 150, 2, "PUT B 2")); // its begin is missing
        take(feed, "WAFERHAND_MCS", progress(RUN, 300, 1, "GET B 1")); // and its end
        take(feed, "WAFERHAND_MCS", progress(RUN, 400, 4, "GET B 1"));
        take(feed, "WAFERHAND_MCS", progress(RUN, 400, 1, "GET B 1"));
        take(feed, "WAFERHAND_MCS", progress(RUN, 500, 3, "GET B 1"));
        take(feed, "WAFERHAND_MCS", progress(RUN, 500, 5, ""));
        check(lines(history).equals(
                  "GET A 1 0-100, PUT B 2 150-300, GET B 1 300-400 failed, GET B 1 400-500, "),
              lines(history));
        check(history.commands(120e3, 160e3).size() == 1, "between two times");
        take(feed, "WAFERHAND_MCS", progress(RUN + 1, 0, 1, "GET C 1"));
        take(feed, "WAFERHAND_STATE", step(RUN + 1, 1));
        check(history.commands(0, 1e6).size() == 1 && lines(history).startsWith("GET C 1 0-"),
              "a new run has its own");
        for (int k = 0; k < 3 * ProximityMarks.MOST; k++) {
            history.add(new ProximityMarks.Progress(
                java.nio.ByteBuffer.wrap(encode(progress(RUN + 1, k, 1, "GET C " + k)))));
        }
        check(history.commands(0, 1e9).size() <= ProximityMarks.MOST, "no more than there is room for");
    }

    /** What the messages say is shown, whatever the values are: which wafer, whether it is ready. */
    private static void believesTheSimulator() {
        final ProximityHistory history = filled(RUN, 1, 10);
        final proximity ready = message(RUN, 11);
        ready.wafer[0] = 5;
        ready.dr_proj_z[0] = 400;
        ready.ready[0] = 1;
        ready.holds[0] = 1;
        history.add(ready);
        final ProximityHistory.Reading reading = history.at(AT_END);
        check(reading.wafer[0] == 5 && reading.values[0][ProximityHistory.Z] == 400,
              "the wafer of the message");
        check((reading.flags[0] & ProximityHistory.READY) != 0, "ready is the message's");
        check((reading.flags[0] & ProximityHistory.CONDITION << ProximityHistory.Z) == 0,
              "a condition is its value's");
        final ProximityHistory.Strip strip = history.strip(0, 0, 20000, 20);
        check(strip.same[10] && strip.joined[11] && !strip.same[11], "no line from one wafer to another");
        final proximity close = message(RUN, 12);
        close.dr_proj_z[0] = Math.nextDown(0.5);
        history.add(close);
        check((history.at(AT_END).flags[0] & ProximityHistory.CONDITION << ProximityHistory.Z) != 0,
              "the last double below the limit holds");
    }

    /** A recorded run, written by the simulator itself. */
    private static ProximityHistory recorded(String path) throws IOException {
        final ProximityPlugin.Collector feed = new ProximityPlugin.Collector();
        final Log log = new Log(path, "r");
        try {
            while (true) {
                final Log.Event event = log.readNext();
                if (event.channel.matches("WAFERHAND_(PROXIMITY|STATE|MCS|CELL)")) {
                    feed.messageReceived(null, event.channel, new LCMDataInputStream(event.data));
                }
            }
        } catch (EOFException end) {
            log.close();
        }
        final ProximityHistory history = feed.history("WAFERHAND_STATE");
        check(history.summary().refused == 0, "each message is whole, by its check, too");
        return history;
    }

    /** An edge grip takes a wafer that is 0.2 mm too large, puts it down, and jams at one that lies off. */
    private static void showsPlungers(String path) throws IOException {
        final ProximityHistory history = recorded(path);
        check(history.summary().grips[0] == ProximityPlungers.EDGE, "the cell says what it is");
        final List<String> words = new ArrayList<>();
        for (long at = 0; at <= history.summary().last; at += 1000) {
            final ProximityPlungers.Plunger plunger = history.plunger(0, at);
            final String text = plunger == null ? "none" : plunger.words();
            if (!text.contains("closes") && !text.contains("opens") &&
                (words.isEmpty() || !words.get(words.size() - 1).equals(text))) {
                words.add(text);
            }
        }
        check(words.equals(List.of("none", "plunger open", "plunger -0.215 mm, holds", "plunger open",
                                   "plunger -3.000 mm, jammed by 0.500 mm", "plunger open")),
              words.toString());
        check(history.copy().plunger(0, AT_END).words().equals("plunger open"), "frozen, too");
        history.add(new ProximityMarks.State(java.nio.ByteBuffer.wrap(encode(step(RUN, 1)))));
        check(history.plunger(0, AT_END).words().equals("plunger open") && history.plunger(1, 999) == null,
              "of another run nothing is left");
        check(history.summary().grips[0] == ProximityPlungers.VACUUM, "nor of another cell");
        final ProximityPlungers many = new ProximityPlungers();
        for (int k = 0; k < 2 * ProximityMarks.MOST; k++) {
            many.add(List.of(new ProximityPlungers.Plunger(k, 1, k, 0)));
        }
        check(many.at(0, 5) == null && many.at(0, AT_END).s == 2 * ProximityMarks.MOST - 1,
              "the oldest are forgotten");
    }

    private static void takesARecordedRun(String path) throws IOException {
        final ProximityHistory history = recorded(path);
        final StringBuilder text = new StringBuilder();
        for (final ProximityMarks.Event event : history.events(0, 0, AT_END)) {
            text.append(event.name()).append(' ').append(history.waferName(event.wafer)).append(", ");
            final ProximityHistory.Reading reading = history.at(event.utime);
            if (event.name().equals("picked")) {
                check(reading.utime == event.utime && reading.wafer[0] == event.wafer,
                      "the wafer that is picked");
                check((reading.flags[0] & ProximityHistory.HOLDS) != 0, "is shown as held");
            }
        }
        check(text.toString().equals("picked Wafer 1, released Wafer 1, picked Wafer 2, released Wafer 2, "),
              text.toString());
        check(lines(history).startsWith(
                  "GET A 1 0-1965, PUT B 2 1965-4302, GET B 1 4302-6119, PUT B 10 6119-8283, "),
              lines(history));
        check(count(paint(new ProximityView(history), 1100, 720), new java.awt.Color(0xdc, 0xe3, 0xea)) >
                  1000,
              "commands are drawn");
    }

    private static void strips() {
        final ProximityHistory history = filled(RUN, 1, 1000);
        final proximity odd = message(RUN, 1001);
        odd.dr_proj_z[0] = Double.NaN;
        odd.ready[0] = 1;
        odd.valve[0] = 0;
        odd.holds[0] = 1;
        odd.wafer[1] = -1;
        history.add(odd);
        history.add(message(RUN, 3000));
        final ProximityHistory.Strip strip = history.strip(0, 0, 1000000, 10);
        check(strip.samples[0] == 99 && strip.samples[9] == 100, "samples");
        check(strip.low[ProximityHistory.Z][5] == 0.5 && strip.high[ProximityHistory.Z][5] == (float)0.599,
              "extremes");
        check(strip.first[ProximityHistory.XY][3] == 300 && strip.last[ProximityHistory.XY][3] == 399,
              "ends");
        check(strip.joined[5] && !strip.joined[0], "joined, but for the first");

        final ProximityHistory.Strip end = history.strip(0, 1001000, 3000001, 2000);
        check(Double.isNaN(end.last[ProximityHistory.Z][0]), "NaN");
        check(end.last[ProximityHistory.XY][0] == 1001, "what stands beside a NaN");
        check(end.flags[0] == (ProximityHistory.READY | ProximityHistory.OPEN | ProximityHistory.HOLDS),
              "flags");
        check(end.samples[1000] == 0 && !end.joined[1998] && !end.joined[1999], "a gap");
        check(Double.isNaN(history.at(1001000).values[1][ProximityHistory.PLANAR]), "no wafer, no values");
        check(history.strip(2, 0, 1e6, 5).samples[0] == 0, "no such gripper");
        check(history.strip(0, 5, 5, 5).samples[0] == 0, "an empty time");
    }

    /** An hour of eight grippers at 200 messages a second stays; then the oldest are forgotten. */
    private static void forgets() {
        final ProximityHistory history = new ProximityHistory();
        final proximity message = message(RUN, 1);
        message.gripper_count = 8;
        final long hour = 720000;
        for (long seq = 1; seq <= 2 * hour; seq++) {
            message.seq = 5 * seq;
            message.utime = 5000 * seq;
            check(history.add(message), "in order");
            if (seq == hour) {
                check(history.summary().first == 5000, "an hour is kept");
                check(history.at(1e6 * 1800).seq == 5 * hour / 2, "and looked up");
                check(history.strip(7, 0, 3.6e9, 500).samples[250] > 1000, "and shown");
            }
        }
        final ProximityHistory.Summary summary = history.summary();
        final long kept = (summary.last - summary.first) / 5000 + 1;
        check(summary.seen == 2 * hour && summary.last == 5000 * 2 * hour, "all seen");
        check(kept <= ProximityHistory.CAPACITY && kept > hour, "the oldest forgotten");
        check(history.at(summary.first).seq * 1000 == summary.first, "the oldest");
        final ProximityHistory copy = history.copy();
        history.add(message(RUN + 1, 1));
        check(copy.at(AT_END).seq == 5 * 2 * hour && copy.summary().run == RUN, "a copy stays");
    }

    // ------------------------------------------------------------------------------------------ the view
    private static BufferedImage paint(ProximityView view, int width, int height) {
        return picture(view, width, height);
    }

    private static BufferedImage picture(javax.swing.JPanel view, int width, int height) {
        final BufferedImage image =
            new BufferedImage(Math.max(1, width), Math.max(1, height), BufferedImage.TYPE_INT_RGB);
        view.setSize(width, height);
        final Graphics2D graphics = image.createGraphics();
        view.paint(graphics);
        graphics.dispose();
        return image;
    }

    private static int count(BufferedImage image, java.awt.Color colour) {
        int pixels = 0;
        for (final int pixel :
             image.getRGB(0, 0, image.getWidth(), image.getHeight(), null, 0, image.getWidth())) {
            if (pixel == colour.getRGB()) {
                pixels++;
            }
        }
        return pixels;
    }

    private static void paints() {
        final ProximityView empty = new ProximityView(new ProximityHistory());
        for (final int size : new int[] {0, 1, 50, 700}) {
            paint(empty, size, size);
        }
        for (int grippers = 1; grippers <= 16; grippers++) {
            final ProximityHistory history = new ProximityHistory();
            for (long seq = 1; seq <= 3000; seq++) {
                final proximity message = message(RUN, seq);
                message.gripper_count = grippers;
                message.eps_planar = grippers == 3 ? Double.NaN : 0.99;
                message.n1_proj_n2[0] = grippers == 4 ? Double.NEGATIVE_INFINITY : 0.9995;
                message.dr_proj_xy_norm[0] = grippers == 5 ? Double.POSITIVE_INFINITY : 1e-12;
                message.eps_projz = grippers == 6 ? 0 : grippers == 7 ? 1e300 : grippers == 8 ? 1e-300 : 0.5;
                history.add(message);
            }
            final ProximityView view = new ProximityView(history);
            for (final int size : new int[] {0, 1, 10, 100, 800}) {
                paint(view, size, size);
                paint(view, size, 900);
                paint(view, 900, size);
            }
            check(count(paint(view, 1920, 1080), ProximityChart.LINE) > 1000, "lines are drawn");
        }
    }

    private static void freezes() {
        final ProximityHistory history = filled(RUN, 1, 30000);
        final ProximityView view = new ProximityView(history);
        final JButton button = (JButton)view.getComponent(0);
        check(button.getText().equals("Freeze"), "a button says what it does");
        button.doClick();
        check(button.getText().equals("Go on"), "and what it would do next");
        final int before = picture(view);
        for (long seq = 30001; seq < 40000; seq++) {
            history.add(message(RUN, seq));
        }
        check(picture(view) == before, "a frozen view stands still");
        check(history.summary().last == 39999000, "time goes on being collected");
        view.scroll(0.5);
        check(picture(view) != before, "it can be scrolled");
        view.scroll(1e9);
        view.scroll(-1e9);
        check(picture(view) == before, "and back, and no further than there is");
        history.add(message(RUN + 1, 1));
        check(picture(view) == before, "another run does not end it");
        view.getActionMap().get("SPACE").actionPerformed(null);
        check(picture(view) != before && button.getText().equals("Freeze"), "it goes on, by the key too");
        view.zoom(-100);
        paint(view, 500, 500);
        view.zoom(100);
        paint(view, 500, 500);
    }

    /** Without its last lines, where the time that is collected is told. */
    private static int picture(ProximityView view) {
        return java.util.Arrays.hashCode(pixels(view));
    }

    private static void drawsMarks() {
        final ProximityHistory history = filled(RUN, 1, 4000);
        final ProximityView view = new ProximityView(history);
        final int alarms = count(paint(view, 900, 700), ProximityChart.LIMIT);
        try {
            history.add(new ProximityMarks.State(java.nio.ByteBuffer.wrap(encode(step(RUN, 3500, 3, 11)))));
            history.add(new ProximityMarks.Progress(
                java.nio.ByteBuffer.wrap(encode(progress(RUN, 3800, 4, "GET A 1")))));
        } catch (IOException impossible) {
            throw new AssertionError(impossible);
        }
        check(count(paint(view, 900, 700), ProximityChart.LIMIT) > alarms + 20, "a near miss is marked");
        for (int x = 0; x < 900; x += 7) {
            for (int y = 0; y < 700; y += 70) {
                view.dispatchEvent(new MouseEvent(view, MouseEvent.MOUSE_MOVED, 0, 0, x, y, 0, false));
                if (y == 350) {
                    paint(view, 900, 700);
                }
            }
        }
    }

    private static int[] pixels(ProximityView view) {
        final BufferedImage image = paint(view, 700, 500);
        return image.getRGB(0, 0, 700, 450, null, 0, 700);
    }

    private static void formats() {
        check(ProximityChart.number(ProximityHistory.Z, Double.NaN).equals("–"), "NaN");
        check(ProximityChart.number(ProximityHistory.Z, 0.4891).equals("0.489 mm"), "mm");
        check(ProximityChart.number(ProximityHistory.Z, 0).equals("0.000 mm"), "0");
        check(ProximityChart.number(ProximityHistory.Z, 4e-13).equals("4e-13 mm"), "tiny");
        check(ProximityChart.number(ProximityHistory.PLANAR, 0.99965732).equals("0.999657"), "cosine");
        check(ProximityChart.niceStep(0.3) == 0.5 && ProximityChart.niceStep(6) == 10, "steps");
        check(ProximityChart.shortest(0.5).equals("0.5") && ProximityChart.shortest(1000).equals("1000"),
              "ticks");
        check(!ProximityChart.holds(ProximityHistory.Z, 0.5, 0.5), "the limit itself is outside");
        check(!ProximityChart.holds(ProximityHistory.PLANAR, 0.99, 0.99), "of the cosine too");
        check(!ProximityChart.holds(ProximityHistory.XY, Double.NaN, 50), "NaN never holds");
    }

    public static void main(String[] arguments) throws Exception {
        findsPlugin();
        decodes();
        survivesGarbage();
        keepsOrder();
        beginsAnew();
        refuses();
        strips();
        forgets();
        paints();
        freezes();
        drawsMarks();
        marksEvents();
        marksCommands();
        marksTasks();
        believesTheSimulator();
        takesARecordedRun(arguments[0]);
        showsPlungers(arguments[2]);
        putsScansTogether();
        showsAScan(arguments[1]);
        refusesPasses();
        showsPasses(arguments[3]);
        formats();
        System.out.println(checks + " checks passed");
    }
}
