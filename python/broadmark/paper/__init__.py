"""What the paper shows, and our results in its place.

*Serpa & Rodrigues, “Broadmark: A Testing Framework for Broad-Phase Collision Detection Algorithms”,
Computer Graphics Forum 2019*, section 5: three scenes, cubes, 1,000 to 1,024,000 objects, 1,000
frames, the mean time of a frame. An algorithm is shown up to the first size at which it takes more
than half a second.

- `algorithms`: the paper's scenes, algorithms with their style and our ids, and Table 2 in numbers
- `times`: our times in the paper's places
- `table2`, `figures`, `strip`, `claims`: Table 2, figures 5 to 7, figure 3, and what it claims
"""
