"""The paper's table, figures and claims, reproduced from results.

*Serpa & Rodrigues, “Broadmark: A Testing Framework for Broad-Phase Collision Detection Algorithms”,
Computer Graphics Forum 2019*, section 5: three scenes, cubes, 1,000 to 1,024,000 objects, 1,000
frames, mean time per frame. An algorithm is shown up to the first size at which a frame takes more
than half a second.

- `algorithms`: the paper's scenes, its algorithms with styles and our ids, and its Table 2
- `times`: our times by the paper's scenes, sizes and algorithms
- `table2`, `figures`, `strip`, `claims`: Table 2, figures 5 to 7, figure 3 and the claims
"""
