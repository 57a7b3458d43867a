-- An edge sensor scans a wafer that lies off the chuck's axis: how far the rim goes in and out, and where the notch is.
cell "../layouts/sensor.lua"

get("A", 1)   put("P", 1)
local scan = edge_scan("P")
local samples, n = scan.samples, #scan.samples
expect(n == 3600 and scan.missed == 0, "a sample each tenth of a degree")

-- Without the notch, the mean of highest and lowest sample gives the radius, half their difference the wafer's offset.
local sorted = table.move(samples, 1, n, 1, {})
table.sort(sorted)
local pixel, inner = 0.007, 150 - 28 / 2
local radius = inner + (sorted[n] + sorted[n // 100]) / 2 * pixel
local off = (sorted[n] - sorted[n // 100]) / 2 * pixel
expect(math.abs(radius - 300.05 / 2) < 0.05, "the radius is 150.025 mm, roughly")
expect(math.abs(off - distance("PA", "W01")) < 0.05, "so far is the wafer beside the axis, roughly")

-- The notch is at the sample that is deepest below those 2 degrees before and after it. Sample k lies at -k/n of a turn
-- from the chuck's x, because the chuck turns and the sensor stands.
local deepest, at = 0, 0
for i = 1, n do
  local around = (samples[(i - 21) % n + 1] + samples[(i + 19) % n + 1]) / 2
  if around - samples[i] > deepest then
    deepest, at = around - samples[i], i
  end
end
local direction = -(scan.first + at - 1) * 360 / n % 360
expect(math.abs(deepest * pixel - 1) < 0.05, "it is 1 mm deep")
-- This direction is from the chuck's axis; from the wafer's middle it may differ, by the angle of the offset seen from the rim.
expect(math.abs(direction - 37) < math.deg(off / radius), "it points to 37 degrees, as the wafer does")
print(("radius %.2f mm, %.2f mm off, notch at %.1f degrees"):format(radius, off, direction))
