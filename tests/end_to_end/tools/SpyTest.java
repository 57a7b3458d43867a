package waferhand;

import java.awt.Graphics2D;
import java.awt.image.BufferedImage;
import java.io.ByteArrayOutputStream;
import java.io.DataOutputStream;
import java.io.IOException;
import java.util.ArrayList;
import java.util.List;
import java.util.Random;
import javax.swing.Action;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMEncodable;
import lcm.spy.SpyPlugin;
import lcm.util.ClassDiscoverer;

/** What tests/end_to_end/spy runs: lcm-spy's view without lcm-spy and without a display. */
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
        for (int g = 0; g < 8; g++) {
            message.dr_proj_z[g] = -0.001 * seq;
            message.dr_proj_xy_norm[g] = seq + g;
            message.n1_proj_n2[g] = 0.999;
            message.valve[g] = 1;
        }
        return message;
    }

    private static ProximityHistory filled(long run, long from, long to) {
        final ProximityHistory history = new ProximityHistory();
        for (long seq = from; seq <= to; seq++) {
            check(history.add(message(run, seq)), "in order");
        }
        return history;
    }

    // ---------------------------------------------------------------------------------------- the plugin
    private static void findsPlugin() throws ReflectiveOperationException {
        final List<Class<?>> found = new ArrayList<>();
        ClassDiscoverer.findClasses((jar, type) -> {
            for (final Class<?> implemented : type.getInterfaces()) {
                if (implemented.equals(SpyPlugin.class)) {
                    found.add(type);
                }
            }
        });
        check(found.size() == 1, "one plugin, not " + found);
        final SpyPlugin plugin = (SpyPlugin)found.get(0).getConstructor().newInstance();
        check(plugin.canHandle(proximity.LCM_FINGERPRINT), "takes proximity");
        check(!plugin.canHandle(state.LCM_FINGERPRINT) && !plugin.canHandle(0), "takes nothing else");
        check(plugin.getAction(null, null).getValue(Action.NAME) != null, "says its name");
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
        message.gripper_names = new String[] {"EE"};
        message.valve_names = new String[] {"eeVacValve[0]"};
        final station taught = new station();
        taught.name = "A";
        message.station_count = 2;
        message.stations = new station[] {taught, taught};
        message.wafer_count = 1;
        message.wafer_names = new String[] {"Wafer 1"};
        message.wafers = new wafer_state[] {new wafer_state()};
        return message;
    }

    private static void decodes() throws IOException {
        final ProximityHistory history = new ProximityHistory();
        final ProximityPlugin.Feed feed = new ProximityPlugin.Feed(history, "WAFERHAND_PROXIMITY");
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
        final ProximityHistory history = filled(RUN, 1, 10);
        final ProximityPlugin.Feed feed = new ProximityPlugin.Feed(history, "WAFERHAND_PROXIMITY");
        final Random random = new Random(1);
        final byte[][] whole = {encode(message(RUN, 11)), encode(names())};
        for (int k = 0; k < 20000; k++) {
            final byte[] bytes = whole[k % 2].clone();
            for (int flips = random.nextInt(4); flips >= 0; flips--) {
                bytes[random.nextInt(bytes.length)] ^= (byte)(1 << random.nextInt(8));
            }
            final int length = random.nextInt(3) == 0 ? random.nextInt(bytes.length) : bytes.length;
            feed.messageReceived(null, k % 2 == 0 ? "WAFERHAND_PROXIMITY" : "WAFERHAND_CELL",
                                 new LCMDataInputStream(bytes, 0, length));
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
        other.gripper_count = 8;
        history.add(other);
        check(history.summary().grippers == 8 && history.summary().seen == 1, "other grippers clear");
    }

    private static void refuses() {
        final ProximityHistory history = filled(RUN, 1, 3);
        for (final int count : new int[] {0, -1, 9, Integer.MAX_VALUE}) {
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
        check(strip.low[ProximityHistory.Z][5] == 0.5 && strip.high[ProximityHistory.Z][5] == 0.599,
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

    private static void forgets() {
        final ProximityHistory history = filled(RUN, 1, 600000);
        final ProximityHistory.Summary summary = history.summary();
        check(summary.seen == 600000 && summary.last == 600000000L, "all seen");
        check(summary.first == (600000 - (1 << 18) + 1) * 1000L, "the oldest forgotten");
        check(history.at(summary.first).seq * 1000 == summary.first, "the ring's beginning");
        final ProximityHistory copy = history.copy();
        history.add(message(RUN + 1, 1));
        check(copy.at(AT_END).seq == 600000 && copy.summary().run == RUN, "a copy stays");
    }

    // ------------------------------------------------------------------------------------------ the view
    private static BufferedImage paint(ProximityView view, int width, int height) {
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
        for (int grippers = 1; grippers <= 8; grippers++) {
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
            check(count(paint(view, 1000, 700), ProximityChart.LINE) > 1000, "lines are drawn");
        }
    }

    private static void pauses() {
        final ProximityHistory history = filled(RUN, 1, 30000);
        final ProximityView view = new ProximityView(history);
        view.pause();
        final int before = java.util.Arrays.hashCode(pixels(view));
        for (long seq = 30001; seq < 40000; seq++) {
            history.add(message(RUN, seq));
        }
        check(java.util.Arrays.hashCode(pixels(view)) == before, "a paused view stands still");
        view.scroll(0.5);
        check(java.util.Arrays.hashCode(pixels(view)) != before, "it can be scrolled");
        view.scroll(1e9);
        view.scroll(-1e9);
        check(java.util.Arrays.hashCode(pixels(view)) == before, "and back, and no further than there is");
        view.pause();
        check(java.util.Arrays.hashCode(pixels(view)) != before, "it goes on");
        view.zoom(-100);
        paint(view, 500, 500);
        view.zoom(100);
        paint(view, 500, 500);
    }

    private static int[] pixels(ProximityView view) {
        final BufferedImage image = paint(view, 700, 500);
        return image.getRGB(0, 0, 700, 500, null, 0, 700);
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
        pauses();
        formats();
        System.out.println(checks + " checks passed");
    }
}
