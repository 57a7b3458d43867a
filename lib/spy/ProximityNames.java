package waferhand;

import java.io.IOException;
import java.nio.charset.StandardCharsets;
import lcm.lcm.LCMDataInputStream;

/** The names in a cell message. They are decoded by hand, because the generated class trusts any count and any length.
 * With a damaged message it asks for arrays of gigabytes.
 */
final class ProximityNames {
    final long layout;
    final String[] grippers, valves, wafers;
    /** The kind of grip, by gripper, as in ProximityPlungers. */
    final byte[] grips;

    private static final int GRIPPERS = 16;
    private static final int WAFERS = 256;
    private static final int FAULTS = 16;
    private static final int SENSORS = 16;
    private static final int BEAMS = 16;
    private static final int DOORS = 8;
    /** Bytes of a station after its name, and in the message before and after the layout's path. */
    private static final int STATION = 3 * 8 + 9 * 8 + 4 + 8 + 4, BEFORE_LAYOUT = 3 * 8,
                             AFTER_PATH = 6 * 8 + 4 + 15 * 8;

    /** Throws an IOException when the data are not a whole cell. */
    ProximityNames(LCMDataInputStream data) throws IOException {
        if (data.readLong() != cell.LCM_FINGERPRINT) {
            throw new IOException("not a cell");
        }
        skip(data, BEFORE_LAYOUT);
        layout = data.readLong();
        text(data);
        skip(data, AFTER_PATH);
        grippers = new String[count(data, GRIPPERS)];
        final int stations = count(data, data.available());
        wafers = new String[count(data, WAFERS)];
        count(data, FAULTS);
        count(data, SENSORS);
        count(data, BEAMS);
        count(data, GRIPPERS);   // outlines
        count(data, WAFERS + 1); // rims
        count(data, GRIPPERS);   // edge grips
        count(data, DOORS);
        valves = new String[grippers.length];
        grips = new byte[grippers.length];
        for (int g = 0; g < grips.length; g++) {
            grips[g] = data.readByte();
        }
        texts(data, grippers);
        texts(data, valves);
        for (int k = 0; k < stations; k++) {
            text(data);
            skip(data, STATION);
        }
        texts(data, wafers);
    }

    private static void skip(LCMDataInputStream data, int bytes) throws IOException {
        if (bytes > data.available()) {
            throw new IOException("too short");
        }
        data.skipBytes(bytes);
    }

    private static int count(LCMDataInputStream data, int most) throws IOException {
        final int count = data.readInt();
        if (count < 0 || count > most) {
            throw new IOException("a count is out of range");
        }
        return count;
    }

    private static void texts(LCMDataInputStream data, String[] texts) throws IOException {
        for (int k = 0; k < texts.length; k++) {
            texts[k] = text(data);
        }
    }

    /** A text is its length in bytes, with the 0 at its end, and then the bytes. */
    private static String text(LCMDataInputStream data) throws IOException {
        final int length = data.readInt();
        if (length < 1 || length > data.available()) {
            throw new IOException("a text is out of range");
        }
        final byte[] bytes = new byte[length];
        data.readFully(bytes);
        return new String(bytes, 0, length - 1, StandardCharsets.UTF_8);
    }
}
