package waferhand;

import java.awt.event.ActionEvent;
import java.io.IOException;
import java.util.HashMap;
import java.util.Map;
import javax.swing.AbstractAction;
import javax.swing.Action;
import javax.swing.JDesktopPane;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import lcm.lcm.LCMSubscriber;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** lcm-spy's view of a channel of edge scans. It collects from lcm-spy's start, whether or not a view is open. */
public final class EdgeScanPlugin implements SpyPlugin {
    private final Collector collector = new Collector();

    public EdgeScanPlugin() {
        LCM.getSingleton().subscribe(".*EDGE_SCAN", collector);
    }

    @Override
    public boolean canHandle(long fingerprint) {
        return fingerprint == edge_scan.LCM_FINGERPRINT;
    }

    /** The action of a double click, in a desktop of its own. Both are null when only its name is asked for. */
    @Override
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return new Open(desktop, channel, collector);
    }

    /** The collected scans of a channel. */
    EdgeScan.History history(String channel) {
        return collector.history(channel);
    }

    private static final class Collector implements LCMSubscriber {
        private static final int HISTORIES = 4;
        private final Map<String, EdgeScan.History> histories = new HashMap<>();

        /** After a few channels all others share one history, which nothing fills. */
        synchronized EdgeScan.History history(String channel) {
            if (histories.size() >= HISTORIES && !histories.containsKey(channel)) {
                return new EdgeScan.History();
            }
            return histories.computeIfAbsent(channel, each -> new EdgeScan.History());
        }

        @Override
        public void messageReceived(LCM lcm, String channel, LCMDataInputStream data) {
            try {
                history(channel).add(new edge_scan(data));
            } catch (IOException | RuntimeException refused) {
                history(channel).refuse();
            }
        }
    }

    private static final class Open extends AbstractAction {
        private static final long serialVersionUID = 1;
        private final transient JDesktopPane desktop;
        private final transient ChannelData channel;
        private final transient Collector collector;

        Open(JDesktopPane desktop, ChannelData channel, Collector collector) {
            super("Edge scans, fit and residuals");
            this.desktop = desktop;
            this.channel = channel;
            this.collector = collector;
        }

        @Override
        public void actionPerformed(ActionEvent event) {
            final EdgeScanView view = new EdgeScanView(collector.history(channel.name));
            SpyWindow.open(desktop, "Edge scans: " + channel.name, view, view::stop);
            view.start();
        }
    }
}
