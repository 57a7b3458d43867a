package waferhand;

import java.awt.event.ActionEvent;
import java.io.IOException;
import java.nio.ByteBuffer;
import java.util.HashMap;
import java.util.Map;
import java.util.regex.Matcher;
import java.util.regex.Pattern;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** lcm-spy's view of a channel of proximity messages. lcm-spy finds it by its interface, and makes one when it starts:
 * from then on it collects, whether or not a view is open.
 */
public final class ProximityPlugin implements SpyPlugin {
    private final Collector collector = new Collector();

    public ProximityPlugin() {
        collector.subscribe(LCM.getSingleton());
    }

    @Override
    public boolean canHandle(long fingerprint) {
        return fingerprint == proximity.LCM_FINGERPRINT;
    }

    /** The action of a double click, in a desktop of its own. Both are null when only its name is asked for. */
    @Override
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return new Open(desktop, channel, collector);
    }

    /** The collected history of a channel. */
    ProximityHistory history(String channel) {
        return collector.history(channel);
    }

    /** Fills histories, one for each prefix that channels have before PROXIMITY, STATE, MCS and CELL. */
    static final class Collector implements LCMSubscriber {
        private static final Pattern CHANNELS = Pattern.compile("(.*?)(PROXIMITY|STATE|MCS|CELL)");
        private static final int HISTORIES = 4;
        private final Map<String, ProximityHistory> histories = new HashMap<>();

        void subscribe(LCM lcm) {
            lcm.subscribe(CHANNELS.pattern(), this);
        }

        /** The history that a channel belongs to. After a few histories all others share one, which nothing fills. */
        synchronized ProximityHistory history(String channel) {
            final Matcher matcher = CHANNELS.matcher(channel);
            final String beginning = matcher.matches() ? matcher.group(1) : channel;
            if (histories.size() >= HISTORIES && !histories.containsKey(beginning)) {
                return new ProximityHistory();
            }
            return histories.computeIfAbsent(beginning, each -> new ProximityHistory());
        }

        @Override
        public void messageReceived(LCM lcm, String channel, LCMDataInputStream data) {
            try {
                take(channel, data);
            } catch (IOException | RuntimeException refused) {
                history(channel).refuse();
            }
        }

        private void take(String channel, LCMDataInputStream data) throws IOException {
            if (channel.endsWith("PROXIMITY")) {
                history(channel).add(new proximity(data));
            } else if (channel.endsWith("CELL")) {
                history(channel).add(new ProximityNames(data));
            } else if (channel.endsWith("STATE")) {
                history(channel).add(new ProximityMarks.State(bytes(data)));
            } else {
                history(channel).add(new ProximityMarks.Progress(bytes(data)));
            }
        }

        private static ByteBuffer bytes(LCMDataInputStream data) {
            return ByteBuffer.wrap(data.getBuffer(), data.getBufferOffset(), data.available()).slice();
        }
    }

    private static final class Open extends AbstractAction {
        private static final long serialVersionUID = 1;
        private final transient JDesktopPane desktop;
        private final transient ChannelData channel;
        private final transient Collector collector;

        Open(JDesktopPane desktop, ChannelData channel, Collector collector) {
            super("Proximity against its limits");
            this.desktop = desktop;
            this.channel = channel;
            this.collector = collector;
        }

        @Override
        public void actionPerformed(ActionEvent event) {
            final ProximityView view = new ProximityView(collector.history(channel.name));
            SpyWindow.open(desktop, "Proximity: " + channel.name, view, view::stop);
            view.start();
        }
    }
}
